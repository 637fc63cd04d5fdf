//! No warp: the frame, the source and the target are the same plane.

use super::{Placement, Placer, Warp};
use crate::geometry::Bounds;
use std::sync::Arc;

/// A rectangle that stands still, as two triangles.
#[derive(Clone, Copy, Debug)]
pub struct IdentityWarp {
    frame: Bounds,
}

impl IdentityWarp {
    /// The rectangle that is shown.
    #[must_use]
    pub const fn new(frame: Bounds) -> Self {
        Self { frame }
    }
}

impl Warp for IdentityWarp {
    fn placer(&self) -> Placer {
        let corners = self.frame.corners();
        let faces = Arc::new([[0, 1, 2], [0, 2, 3]]);
        Placer::new(Placement::of_source(faces, &corners, &corners), |_, _| {})
    }
}
