//! One system solves: wherever [`Blend`] changed, its frame is sought.
//!
//! Guarantees: nothing is allocated and nothing can fail; an unchanged t costs
//! nothing and marks nothing as changed.

use bevy::platform::time::Instant;
use bevy::prelude::*;

use super::components::{Blend, Morph};
use super::times::FrameTimes;

/// Seeks every frame whose blend parameter moved.
pub(super) fn solve_frames(
    mut morphs: Query<(&Blend, &mut Morph), Changed<Blend>>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (&Blend { t }, mut morph) in &mut morphs {
        // Read through a shared borrow: only the seek below marks the frame as
        // changed, and what is drawn goes by that.
        if t.is_finite() && morph.frame().t() != t {
            morph.0.seek(t);
            has_sought = true;
        }
    }
    if has_sought {
        times.solve.record(start.elapsed());
    }
}
