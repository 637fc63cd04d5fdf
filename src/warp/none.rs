//! No warp: the frame, the source and the target are the same plane.

use super::{Placement, Placer, Warp};
use crate::geometry::Bounds;
use std::sync::Arc;

/// A rectangle that stands still, as two triangles.
#[derive(Clone, Copy, Debug)]
pub struct Still {
    frame: Bounds,
}

impl Still {
    /// The rectangle that is shown.
    #[must_use]
    pub const fn new(frame: Bounds) -> Self {
        Self { frame }
    }
}

impl Warp for Still {
    fn placer(&self) -> Box<dyn Placer> {
        let corners = self.frame.corners();
        let faces = Arc::new([[0, 1, 2], [0, 2, 3]]);
        Box::new(Placement::of_source(faces, &corners, &corners))
    }
}

/// One that does not change.
impl Placer for Placement {
    fn place(&mut self, _t: f64) {}

    fn placement(&self) -> &Placement {
        self
    }
}
