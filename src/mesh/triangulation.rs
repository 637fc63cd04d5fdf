//! Triangulation of one connected piece, bounded by closed walks:
//! constrained Delaunay (Chew 1989), plain or refined.
//!
//! A walk may run along a slit, there and back over the same points: each of
//! its corners is a vertex of its own, so that the mesh opens along it.
//!
//! Guaranteed: the walks' corners come first and in order, faces are
//! counter-clockwise and fill the piece, which is connected, and its boundary
//! loops are the walks. What is no such piece is refused. Not guaranteed:
//! that a refinement reaches its angle; beside sharp corners and unsplit
//! edges none can.

mod domain;
mod refine;

pub use domain::TriangulationError;
pub use refine::RefinementOptions;

use crate::geometry::DVec2;
use crate::work::progress::Progress;
use domain::TriangulationDomain;
use spade::handles::{FaceHandle, InnerTag};
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// Points, the walks' first, and counter-clockwise faces.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinedTriangulation {
    /// The walks' corners in order, then the points that were added.
    pub points: Vec<DVec2>,
    /// Three indices into the points each.
    pub faces: Vec<[u32; 3]>,
}

/// The constrained Delaunay triangulation without further points, in
/// O(n log n): for a single walk n − 2 faces.
///
/// The first walk is the outer boundary, counter-clockwise; the others are
/// holes, clockwise.
///
/// # Errors
/// [`TriangulationError`] if the walks bound no single piece.
///
/// ```
/// use morphospace::{geometry::DVec2, mesh::triangulation::constrained_delaunay};
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
/// assert_eq!(constrained_delaunay(&[square])?.len(), 2);
/// # Ok::<(), morphospace::mesh::triangulation::TriangulationError>(())
/// ```
pub fn constrained_delaunay<W: AsRef<[DVec2]>>(
    walks: &[W],
) -> Result<Vec<[u32; 3]>, TriangulationError> {
    let domain = TriangulationDomain::of(walks)?;
    Ok(domain.faces())
}

/// The constrained Delaunay triangulation, refined; no edge of a walk is
/// split.
///
/// # Errors
/// [`TriangulationError`] if the walks bound no single piece, or if the work
/// is cancelled.
pub fn refined_delaunay<W: AsRef<[DVec2]>>(
    walks: &[W],
    refinement: &RefinementOptions,
    progress: &dyn Progress,
) -> Result<RefinedTriangulation, TriangulationError> {
    let mut domain = TriangulationDomain::of(walks)?;
    domain.refine(refinement, progress)?;
    Ok(RefinedTriangulation {
        points: domain.points(walks),
        faces: domain.faces(),
    })
}

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
    // Equal points have become one; points on a line have no face.
    if delaunay.num_vertices() != points.len() || delaunay.num_inner_faces() == 0 {
        return Err(TriangulationError::NotSimple);
    }
    let corners = |face: FaceHandle<'_, InnerTag, _, _, _, _>| {
        face.vertices().map(|v| v.fix().index() as u32)
    };
    Ok(delaunay.inner_faces().map(corners).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{orient2d, twice_signed_area};
    use crate::work::progress::Silent;

    fn points<const N: usize>(points: [(f64, f64); N]) -> Vec<DVec2> {
        points.map(DVec2::from).to_vec()
    }

    fn u_shape() -> Vec<DVec2> {
        points([
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ])
    }

    /// A square from `low` to `high`, counter-clockwise.
    fn square(low: f64, high: f64) -> Vec<DVec2> {
        points([(low, low), (high, low), (high, high), (low, high)])
    }

    fn hole(low: f64, high: f64) -> Vec<DVec2> {
        square(low, high).into_iter().rev().collect()
    }

    fn area(points: &[DVec2], faces: &[[u32; 3]]) -> f64 {
        let of = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|v| points[v as usize]);
            assert!(orient2d(a, b, c) > 0.0);
            twice_signed_area(a, b, c)
        };
        0.5 * faces.iter().map(of).sum::<f64>()
    }

    #[test]
    fn faces_fill_a_concave_polygon_and_nothing_else() {
        let faces = constrained_delaunay(&[u_shape()]).expect("simple");
        assert_eq!(faces.len(), 6);
        assert!((area(&u_shape(), &faces) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn a_hole_stays_empty() {
        let walks = [square(0.0, 4.0), hole(1.0, 2.0)];
        let faces = constrained_delaunay(&walks).expect("a ring");
        assert_eq!(faces.len(), 8);
        assert!((area(&walks.concat(), &faces) - 15.0).abs() < 1e-12);
    }

    #[test]
    fn a_ring_cut_open_is_a_disc() {
        let corners = square(0.0, 4.0);
        let inner = hole(1.0, 2.0);
        let mut walk = vec![corners[0]];
        walk.extend([3, 0, 1, 2, 3].map(|k| inner[k]));
        walk.extend([0, 1, 2, 3].map(|k| corners[k]));
        let faces = constrained_delaunay(std::slice::from_ref(&walk)).expect("a slit");
        assert_eq!(faces.len() + 2, walk.len());
        assert!((area(&walk, &faces) - 15.0).abs() < 1e-12);
        let fine = RefinementOptions {
            max_edge: Some(0.3),
            max_points: 1000,
        };
        let mesh = refined_delaunay(std::slice::from_ref(&walk), &fine, &Silent).expect("a slit");
        assert_eq!(mesh.points[..walk.len()], walk);
        assert!((area(&mesh.points, &mesh.faces) - 15.0).abs() < 1e-9);
        assert_eq!(mesh.faces.len() + walk.len() + 2, 2 * mesh.points.len());
    }

    #[test]
    fn a_refinement_keeps_the_boundary() {
        let fine = RefinementOptions {
            max_edge: Some(0.3),
            max_points: 1000,
        };
        let mesh = refined_delaunay(&[u_shape()], &fine, &Silent).expect("simple");
        assert_eq!(mesh.points[..8], u_shape());
        assert!(mesh.faces.len() > 5);
        assert!((area(&mesh.points, &mesh.faces) - 7.0).abs() < 1e-9);
        assert_eq!(mesh.points.iter().filter(|p| p.y == 0.0).count(), 2);
    }

    #[test]
    fn what_bounds_no_single_piece_is_refused() {
        let refused = |walks: &[Vec<DVec2>]| constrained_delaunay(walks).expect_err("no piece");
        let bow = points([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(refused(&[bow]), TriangulationError::NotSimple);
        let twice = points([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 1.0)]);
        assert_eq!(refused(&[twice]), TriangulationError::NotSimple);
        let nan = vec![DVec2::ZERO, DVec2::X, DVec2::NAN];
        assert_eq!(refused(&[nan]), TriangulationError::OutOfRange);
        let not_one = TriangulationError::NotOnePiece;
        assert_eq!(refused(&[hole(0.0, 1.0)]), not_one);
        assert_eq!(refused(&[square(0.0, 1.0), hole(2.0, 3.0)]), not_one);
        assert_eq!(refused(&[square(0.0, 1.0), square(2.0, 3.0)]), not_one);
        assert_eq!(refused(&[hole(1.0, 2.0), square(0.0, 4.0)]), not_one);
        let nested = [square(0.0, 9.0), hole(1.0, 8.0), hole(2.0, 3.0)];
        assert_eq!(refused(&nested), not_one);
        let touching = [square(0.0, 4.0), hole(0.0, 1.0)];
        assert_eq!(refused(&touching), TriangulationError::NotSimple);
    }

    #[test]
    fn an_hourglass_is_two_pieces() {
        let waist = (1.0, 1.0);
        let glass = points([(0.0, 0.0), (2.0, 0.0), waist, (2.0, 2.0), (0.0, 2.0), waist]);
        assert!(constrained_delaunay(&[glass]).is_err());
    }
}
