//! Whether the graphics card has compiled everything that it is asked to draw
//! with: until then, shapes are missing from pictures.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};

/// Frames in a row without a missing pipeline after which all is there: the
/// first may have been extracted before the request, the second queues what is
/// missing, the third was drawn with it.
const READY_FRAMES: u32 = 3;

/// Counts frames in a row in which nothing was missing; shared by Bevy's main
/// and render worlds, and there only where there is a render world. A program
/// that draws only when something has changed goes on drawing until it is
/// ready: what is missing comes without an event.
#[derive(Resource, Clone, Debug, Default)]
pub struct PipelinesReady(Arc<AtomicU32>);

impl PipelinesReady {
    /// Something new is to be drawn.
    pub(super) fn start_over(&self) {
        self.0.store(0, Ordering::Relaxed);
    }

    /// Everything that is to be drawn can be drawn.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= READY_FRAMES
    }
}

/// Watches the pipelines where there is a render world.
pub(super) fn watch_pipelines(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    let ready = PipelinesReady::default();
    render_app
        .insert_resource(ready.clone())
        // After rendering: what a frame was short of is queued by then.
        .add_systems(Render, count_ready_frames.in_set(RenderSystems::Cleanup));
    app.insert_resource(ready);
}

fn count_ready_frames(cache: Option<Res<PipelineCache>>, ready: Res<PipelinesReady>) {
    // Before there is a cache nothing can have been drawn.
    let waits = cache.is_none_or(|cache| cache.waiting_pipelines().next().is_some());
    if waits {
        ready.start_over();
    } else {
        ready.0.fetch_add(1, Ordering::Relaxed);
    }
}
