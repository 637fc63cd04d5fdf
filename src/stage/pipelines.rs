//! Tracks whether the graphics card has compiled all pipelines it needs. Until then, shapes are
//! missing from the picture.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};

/// Number of consecutive frames without a missing pipeline after which everything is drawn.
/// Derived: the first frame may have been extracted before the request, the second one queues the
/// missing pipelines, and the third one is drawn with them.
const READY_FRAMES: u32 = 3;

/// Counts consecutive frames without missing pipelines. Shared by Bevy's main and render worlds; it
/// exists only if there is a render world.
///
/// A program that draws only after changes must keep drawing until this is ready, because pipelines
/// become ready without an event.
#[derive(Resource, Clone, Debug, Default)]
pub struct PipelinesReady(Arc<AtomicU32>);

impl PipelinesReady {
    /// Restarts the count, because something new is to be drawn.
    pub(super) fn reset(&self) {
        self.0.store(0, Ordering::Relaxed);
    }

    /// Whether everything can be drawn.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= READY_FRAMES
    }
}

/// Starts tracking, if there is a render world.
pub(super) fn watch_pipelines(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    let ready = PipelinesReady::default();
    render_app
        .insert_resource(ready.clone())
        // After rendering, when the missing pipelines of the frame have been queued.
        .add_systems(Render, count_ready_frames.in_set(RenderSystems::Cleanup));
    app.insert_resource(ready);
}

/// Counts the frame if no pipeline is waiting, or restarts the count.
fn count_ready_frames(cache: Option<Res<PipelineCache>>, ready: Res<PipelinesReady>) {
    // Without a cache nothing has been drawn yet.
    let is_waiting = cache.is_none_or(|cache| cache.waiting_pipelines().next().is_some());
    if is_waiting {
        ready.reset();
    } else {
        ready.0.fetch_add(1, Ordering::Relaxed);
    }
}
