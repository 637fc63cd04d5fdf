//! The identity warp: no point moves, so frame, source and target coordinates agree.
//!
//! Blends that only mix colours or distances use it.

use super::{Placement, Placer, Warp};
use crate::geometry::Bounds;
use std::sync::Arc;

/// Identity warp of a rectangle, which is drawn as two triangles.
#[derive(Clone, Copy, Debug)]
pub struct IdentityWarp {
    frame: Bounds,
}

impl IdentityWarp {
    /// Creates the identity warp of the visible rectangle.
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
