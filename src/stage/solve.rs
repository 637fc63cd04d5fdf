//! One system solves: wherever [`Blend`] changed, its frame is sought.
//!
//! Guarantees: nothing is allocated and nothing can fail; an unchanged t costs
//! nothing and marks nothing as changed.

use std::time::Instant;

use bevy::ecs::component::Mutable;
use bevy::prelude::*;

use crate::transition::Frame;

use super::components::{ArapSolver, Blend, FieldSprite, PictureSprite};
use super::times::FrameTimes;

/// A component that holds the frame on the stage.
pub(super) trait HasFrame: Component<Mutability = Mutable> {
    fn frame(&self) -> &Frame;
    fn frame_mut(&mut self) -> &mut Frame;
}

impl HasFrame for ArapSolver {
    fn frame(&self) -> &Frame {
        &self.0
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.0
    }
}

impl HasFrame for FieldSprite {
    fn frame(&self) -> &Frame {
        &self.0
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.0
    }
}

impl HasFrame for PictureSprite {
    fn frame(&self) -> &Frame {
        &self.0
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.0
    }
}

/// Seeks every frame whose blend parameter moved.
pub(super) fn solve_frames(
    mut solids: Query<(&Blend, &mut ArapSolver), Changed<Blend>>,
    mut fields: Query<(&Blend, &mut FieldSprite), Changed<Blend>>,
    mut pictures: Query<(&Blend, &mut PictureSprite), Changed<Blend>>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut sought = 0;
    for (blend, solver) in &mut solids {
        sought += u32::from(seek(blend.t, solver));
    }
    for (blend, sprite) in &mut fields {
        sought += u32::from(seek(blend.t, sprite));
    }
    for (blend, sprite) in &mut pictures {
        sought += u32::from(seek(blend.t, sprite));
    }
    if sought > 0 {
        times.solve.record(start.elapsed());
    }
}

fn seek<F: HasFrame>(t: f64, mut at: Mut<F>) -> bool {
    let moves = t.is_finite() && at.frame().t() != t;
    if moves {
        at.frame_mut().seek(t);
    }
    moves
}
