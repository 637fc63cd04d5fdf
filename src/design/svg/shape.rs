//! What is painted at once.

use super::layers::Rings;
use crate::colour::{Paint, Rgb};
use crate::geometry::Bounds;

/// What one fill or one stroke covers.
pub(super) struct Shape {
    /// To be filled by winding.
    pub rings: Rings,
    pub paint: Paint,
    pub is_stroke: bool,
    /// The id of its element, if it has one.
    pub name: String,
}

impl Shape {
    pub(super) fn is_white(&self) -> bool {
        self.paint.colour == Rgb([u8::MAX; 3])
    }

    pub(super) fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.rings.iter().flatten().copied())
    }
}
