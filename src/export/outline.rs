//! Closed contours in pixels, of which everything that is filled is made.

use crate::geometry::DVec2;

/// Shapes with a coordinate beyond this are not drawn: extrapolated films can
/// leave every picture by many orders of magnitude, and 32-bit rasterisers
/// lose all their digits out there.
pub const MAX_COORDINATE_PX: f64 = 1.0e7;

/// One step of an [`OutlinePath`], in pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathCommand {
    /// Starts a new closed contour at the point.
    Move(DVec2),
    /// A straight line to the point.
    Line(DVec2),
    /// A quadratic Bézier curve: control point, end point.
    Quad(DVec2, DVec2),
    /// A cubic Bézier curve: two control points, end point.
    Cubic(DVec2, DVec2, DVec2),
    /// Closes the contour.
    Close,
}

/// Closed contours that are filled together by the nonzero rule.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutlinePath {
    /// Contours, each from a [`PathCommand::Move`] to a [`PathCommand::Close`].
    pub steps: Vec<PathCommand>,
}

impl OutlinePath {
    /// Adds a closed polygon; one with a point that cannot be drawn is left out.
    pub fn push_ring(&mut self, ring_px: impl ExactSizeIterator<Item = DVec2> + Clone) {
        if ring_px.len() < 3 || !ring_px.clone().all(is_drawable) {
            return;
        }
        let step = |(i, p)| {
            if i == 0 {
                PathCommand::Move(p)
            } else {
                PathCommand::Line(p)
            }
        };
        self.steps.extend(ring_px.enumerate().map(step));
        self.steps.push(PathCommand::Close);
    }
}

/// Whether a point can be drawn at all.
pub(super) fn is_drawable(p: DVec2) -> bool {
    p.is_finite() && p.abs().max_element() <= MAX_COORDINATE_PX
}
