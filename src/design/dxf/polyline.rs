//! Vertices of polylines, shared by LWPOLYLINE, POLYLINE and the boundaries of HATCH.

use super::curve::DxfCurve;
use super::error::EntityFault;
use super::pairs::GroupPair;
use crate::geometry::DVec2;

/// Vertex of a polyline, with the properties of the line or arc that starts there.
#[derive(Clone, Copy)]
pub(super) struct PolylineVertex {
    pub point: DVec2,
    /// Tangent of a quarter of the arc's angle, or 0 for a line.
    pub bulge: f64,
    /// Widths at the start and at the end.
    pub widths: [f64; 2],
}

impl PolylineVertex {
    /// Reads the vertices of a polyline from a list of pairs.
    pub fn list(pairs: &[GroupPair]) -> Result<Vec<Self>, EntityFault> {
        let mut corners: Vec<Self> = Vec::new();
        for pair in pairs {
            match (pair.code, corners.last_mut()) {
                (10, _) => corners.push(Self {
                    point: DVec2::new(pair.real()?, 0.0),
                    bulge: 0.0,
                    widths: [0.0; 2],
                }),
                (20, Some(corner)) => corner.point.y = pair.real()?,
                (40, Some(corner)) => corner.widths[0] = pair.real()?,
                (41, Some(corner)) => corner.widths[1] = pair.real()?,
                (42, Some(corner)) => corner.bulge = pair.real()?,
                _ => {}
            }
        }
        Ok(corners)
    }
}

/// Returns the sides of a polyline.
pub(super) fn polyline_curves(
    corners: &[PolylineVertex],
    is_closed: bool,
) -> impl Iterator<Item = DxfCurve> {
    // An open polyline has one line or arc fewer than it has vertices.
    let last = corners.len().saturating_sub(1);
    let sides = if is_closed { corners.len() } else { last };
    (0..sides).map(|i| {
        let (a, b) = (&corners[i], &corners[(i + 1) % corners.len()]);
        DxfCurve::from_bulge(a.point, b.point, a.bulge)
    })
}
