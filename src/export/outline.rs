//! Closed contours of lines and Bézier curves, in pixels: the geometry of everything that is filled
//! or stroked.

use crate::geometry::DVec2;
use std::sync::Arc;

/// Maximum absolute value of a coordinate that is drawn, in pixels (derived: beyond it, the 32-bit
/// coordinates of rasterisers have no sub-pixel precision). At t far outside [0, 1], points can lie
/// outside the image by many times its size.
pub const MAX_COORDINATE_PX: f64 = 1.0e7;

/// One path command of an [`OutlinePath`], in pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathCommand {
    /// Starts a new contour at the point.
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
    /// Contours, each running from a [`PathCommand::Move`] to a [`PathCommand::Close`].
    pub commands: Vec<PathCommand>,
    /// Names of the paint layers from which the contours come, in the order of the contours.
    pub names: Vec<NamedContours>,
}

/// Run of consecutive contours of an outline that come from one paint layer.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedContours {
    /// Number of contours.
    pub count: usize,
    /// Name of the paint layer; empty if it has none.
    pub name: Arc<str>,
}

impl OutlinePath {
    /// Adds closed polygons that come from a paint layer with the given name.
    pub(super) fn push_named_rings(
        &mut self,
        rings_px: impl Iterator<Item = impl ExactSizeIterator<Item = DVec2> + Clone>,
        name: &Arc<str>,
    ) {
        let first = self.commands.len();
        rings_px.for_each(|ring| self.push_ring(ring));
        let is_start = |command: &&PathCommand| matches!(command, PathCommand::Move(_));
        self.names.push(NamedContours {
            count: self.commands[first..].iter().filter(is_start).count(),
            name: Arc::clone(name),
        });
    }

    /// Adds a closed polygon. Polygons with fewer than three points or an undrawable point are
    /// omitted.
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
        self.commands.extend(ring_px.enumerate().map(step));
        self.commands.push(PathCommand::Close);
    }
}

/// Returns whether a point is finite and within [`MAX_COORDINATE_PX`].
pub(super) fn is_drawable(p: DVec2) -> bool {
    p.is_finite() && p.abs().max_element() <= MAX_COORDINATE_PX
}
