//! Moves the frame of each morph to the t of its [`Blend`].
//!
//! If the graphics card evaluates all visible render parts of a morph from a recording, the CPU
//! computes its vertices only when they are read; see [`Morph::frame`].
//!
//! Guaranteed: nothing is allocated and nothing can fail. An unchanged t costs nothing, and the
//! morph is not marked as changed.

use bevy::platform::time::Instant;
use bevy::prelude::*;

use super::components::{Blend, Morph, StageStyle};
use super::frame_times::FrameTimes;
use super::parts::StagePart;
use super::uploaded_recording::UploadState;

/// Components needed to move a morph: its blend parameter, the morph, and the components that
/// determine whether the CPU must compute its vertices.
type MorphEntities = (
    &'static Blend,
    &'static mut Morph,
    Option<(&'static UploadState, &'static StageStyle, &'static Children)>,
);

/// Moves the frame of every morph whose blend parameter changed.
pub(super) fn solve_frames(
    mut morphs: Query<MorphEntities, Changed<Blend>>,
    parts: Query<&StagePart>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (&Blend { t }, mut morph, drawn) in &mut morphs {
        // The comparison uses a shared borrow, so only an actual move marks the morph as changed
        // and triggers drawing.
        if t.is_finite() && morph.frame().t() != t {
            let is_played = drawn.is_some_and(|(sent, style, children)| {
                let reads =
                    |part: &StagePart| part.needs_positions(morph.frame(), t, style, Some(sent));
                !parts.iter_many(children).any(reads)
            });
            if is_played {
                morph.0.set_time(t);
            } else {
                morph.0.seek(t);
            }
            has_sought = true;
        }
    }
    if has_sought {
        times.solve.record(start.elapsed());
    }
}
