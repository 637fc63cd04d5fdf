//! Points along a rectangle.

use crate::geometry::{Bounds, DVec2, ring_edges};

/// Points along the rectangle at most so far apart, counter-clockwise from its
/// lower left corner.
pub(super) fn border_points(frame: &Bounds, spacing: f64) -> Vec<DVec2> {
    let mut points = Vec::new();
    for (a, b) in ring_edges(&frame.corners()) {
        let pieces = (a.distance(b) / spacing).ceil().max(1.0) as u32;
        // To the last bit on the side: a sliver beside it would fold.
        points.extend((0..pieces).map(|i| a + (b - a) * (f64::from(i) / f64::from(pieces))));
    }
    points
}
