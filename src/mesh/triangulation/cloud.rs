//! Points without a boundary of their own.

use super::domain::TriangulationError;
use crate::geometry::DVec2;
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// The Delaunay triangulation of points, over their convex hull: all of them
/// are corners, in the order given.
///
/// # Errors
/// [`TriangulationError`] for fewer than three points, points out of range,
/// points that coincide, and points on one line.
///
/// ```
/// use morphospace::{geometry::DVec2, mesh::triangulation::delaunay};
/// let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5)];
/// assert_eq!(delaunay(&corners.map(DVec2::from))?.len(), 4);
/// # Ok::<(), morphospace::mesh::triangulation::TriangulationError>(())
/// ```
pub fn delaunay(points: &[DVec2]) -> Result<Vec<[u32; 3]>, TriangulationError> {
    if points.len() < 3 {
        return Err(TriangulationError::TooFewPoints(points.len()));
    }
    let plain: Vec<_> = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let delaunay = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(plain)
        .map_err(|_| TriangulationError::OutOfRange)?;
    if delaunay.num_vertices() != points.len() || delaunay.num_inner_faces() == 0 {
        return Err(TriangulationError::NotSimple);
    }
    let corners = |face: spade::handles::FaceHandle<'_, spade::handles::InnerTag, _, _, _, _>| {
        face.vertices().map(|v| v.fix().index() as u32)
    };
    Ok(delaunay.inner_faces().map(corners).collect())
}
