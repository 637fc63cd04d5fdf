//! Tracks whether all render pipelines that the stage needs are compiled. Until then, shapes are
//! missing from the stage.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};

/// Number of consecutive frames without a missing pipeline after which no shape is missing from the
/// stage. Derived: the first of these frames may have been passed to the render world before the
/// count was restarted, the second one queues the missing pipelines, and the third one is drawn
/// with them.
const READY_FRAMES: u32 = 3;

/// Number of consecutive frames without missing pipelines so far. Bevy's main and render worlds
/// share the resource; it exists only if there is a render world.
///
/// A program that redraws only after changes must keep redrawing until [`Self::is_ready`] returns
/// true, because Bevy sends no event when a pipeline is compiled.
#[derive(Resource, Clone, Debug, Default)]
pub struct PipelinesReady(Arc<AtomicU32>);

impl PipelinesReady {
    /// Restarts the count; called when something new is to be drawn.
    pub(super) fn reset(&self) {
        self.0.store(0, Ordering::Relaxed);
    }

    /// Returns whether all pipelines are compiled, so that no shape is missing from the stage.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= READY_FRAMES
    }
}

/// Adds [`PipelinesReady`] and the system that counts frames, if there is a render world.
pub(super) fn watch_pipelines(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    let ready = PipelinesReady::default();
    render_app
        .insert_resource(ready.clone())
        // The system runs after rendering, when the frame's missing pipelines are queued.
        .add_systems(Render, count_ready_frames.in_set(RenderSystems::Cleanup));
    app.insert_resource(ready);
}

/// Counts the current frame if no pipeline is waiting to be compiled; otherwise restarts the count.
fn count_ready_frames(cache: Option<Res<PipelineCache>>, ready: Res<PipelinesReady>) {
    // If there is no pipeline cache, nothing has been drawn yet.
    let is_waiting = cache.is_none_or(|cache| cache.waiting_pipelines().next().is_some());
    if is_waiting {
        ready.reset();
    } else {
        ready.0.fetch_add(1, Ordering::Relaxed);
    }
}
