//! Moves the frame of each morph to its [`Blend`].
//!
//! A frame that the graphics card plays is placed only if its positions are read: see
//! [`Morph::frame`].
//!
//! Guaranteed: nothing is allocated and nothing can fail; an unchanged t costs nothing and marks
//! nothing as changed.

use bevy::platform::time::Instant;
use bevy::prelude::*;

use super::components::{Blend, Morph, StageStyle};
use super::frame_times::FrameTimes;
use super::parts::StagePart;
use super::uploaded_recording::UploadState;

/// Components that moving a frame needs: the morph, and what decides whether its positions are
/// read.
type MorphEntities = (
    &'static Blend,
    &'static mut Morph,
    Option<(&'static UploadState, &'static StageStyle, &'static Children)>,
);

/// Moves every frame whose blend parameter changed.
pub(super) fn solve_frames(
    mut morphs: Query<MorphEntities, Changed<Blend>>,
    parts: Query<&StagePart>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (&Blend { t }, mut morph, drawn) in &mut morphs {
        // Compared through a shared borrow: only an actual move marks the frame as changed and
        // triggers drawing.
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
