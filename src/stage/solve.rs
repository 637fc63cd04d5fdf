//! One system solves: wherever [`Blend`] changed, its frame is sought.
//!
//! A frame that the graphics card plays is placed only if somebody reads it: see
//! [`Morph::frame`].
//!
//! Guarantees: nothing is allocated and nothing can fail; an unchanged t costs
//! nothing and marks nothing as changed.

use bevy::platform::time::Instant;
use bevy::prelude::*;

use super::components::{Blend, Morph, StageStyle};
use super::frame_times::FrameTimes;
use super::parts::StagePart;
use super::uploaded_recording::UploadState;

/// A frame, and what is drawn of it.
type MorphEntities = (
    &'static Blend,
    &'static mut Morph,
    Option<(&'static UploadState, &'static StageStyle, &'static Children)>,
);

/// Seeks every frame whose blend parameter moved.
pub(super) fn solve_frames(
    mut morphs: Query<MorphEntities, Changed<Blend>>,
    parts: Query<&StagePart>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (&Blend { t }, mut morph, drawn) in &mut morphs {
        // Read through a shared borrow: only the seek below marks the frame as
        // changed, and what is drawn goes by that.
        if t.is_finite() && morph.frame().t() != t {
            let is_played = drawn.is_some_and(|(sent, style, children)| {
                let reads = |part: &StagePart| part.reads(morph.frame(), t, style, Some(sent));
                !parts.iter_many(children).any(reads)
            });
            if is_played {
                morph.0.turn(t);
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
