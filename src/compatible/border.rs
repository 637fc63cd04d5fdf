//! Evenly spaced points along the border of the frame, for meshes that cover the whole frame.

use crate::geometry::{Bounds, DVec2, ring_edges};

/// Returns points along the border of `frame`, counter-clockwise from its lower left corner.
/// Neighbouring points are at most `spacing` apart.
pub(super) fn border_points(frame: &Bounds, spacing: f64) -> Vec<DVec2> {
    let mut points = Vec::new();
    for (a, b) in ring_edges(&frame.corners()) {
        let pieces = (a.distance(b) / spacing).ceil().max(1.0) as u32;
        // This formula keeps points exactly on an axis-parallel side. If rounding moved a point off
        // the side, the triangulation could have a very thin or folded face there.
        points.extend((0..pieces).map(|i| a + (b - a) * (f64::from(i) / f64::from(pieces))));
    }
    points
}
