//! Triangulates a connected region (piece) that is bounded by closed loops, by constrained Delaunay
//! triangulation (Chew 1989), optionally refined. [`delaunay`] triangulates a set of points
//! instead.
//!
//! A loop may run along a slit, there and back over the same points. Each of its corners then
//! becomes a separate vertex, so that the mesh opens along the slit.
//!
//! Guaranteed: the first vertices are the loops' corners, in order. Faces are counter-clockwise and
//! fill the piece; the boundary loops of the mesh are the given loops. Invalid input is rejected.
//! Not guaranteed: that refinement reaches the minimum angle that it aims for. This is impossible
//! next to sharp corners, and next to long edges of the loops, because refinement never splits an
//! edge of a loop.

mod domain;
mod refine;

pub use domain::TriangulationError;
pub use refine::RefinementOptions;

use crate::geometry::DVec2;
use crate::work::progress::Progress;
use domain::TriangulationDomain;
use spade::handles::{FaceHandle, InnerTag};
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// Points and counter-clockwise faces of a refined triangulation.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinedTriangulation {
    /// The loops' corners in order, then the points added by refinement.
    pub points: Vec<DVec2>,
    /// Three point indices for each face.
    pub faces: Vec<[u32; 3]>,
}

/// Returns the faces of the constrained Delaunay triangulation without added points, in O(n log n).
/// A single loop of n corners gives n − 2 faces.
///
/// The first loop is the outer boundary, counter-clockwise; the others are holes, clockwise.
///
/// # Errors
/// [`TriangulationError`] if the loops do not bound one connected piece.
///
/// ```
/// use morphospace::{geometry::DVec2, mesh::triangulation::constrained_delaunay};
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
/// assert_eq!(constrained_delaunay(&[square])?.len(), 2);
/// # Ok::<(), morphospace::mesh::triangulation::TriangulationError>(())
/// ```
pub fn constrained_delaunay<W: AsRef<[DVec2]>>(
    loops: &[W],
) -> Result<Vec<[u32; 3]>, TriangulationError> {
    let domain = TriangulationDomain::of(loops)?;
    Ok(domain.faces())
}

/// Returns the constrained Delaunay triangulation of the piece that the loops bound (see
/// [`constrained_delaunay`]), refined without splitting any edge of a loop.
///
/// # Errors
/// [`TriangulationError`] if the loops do not bound one connected piece, or if the work is
/// cancelled.
pub fn refined_delaunay<W: AsRef<[DVec2]>>(
    loops: &[W],
    refinement: &RefinementOptions,
    progress: &dyn Progress,
) -> Result<RefinedTriangulation, TriangulationError> {
    let mut domain = TriangulationDomain::of(loops)?;
    domain.refine(refinement, progress)?;
    Ok(RefinedTriangulation {
        points: domain.points(loops),
        faces: domain.faces(),
    })
}

/// Returns the faces of the Delaunay triangulation of points, which fills their convex hull. All
/// points are vertices, in the order given.
///
/// # Errors
/// [`TriangulationError`] for fewer than three points, points out of range, coinciding points, or
/// points on one line.
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
    // The library merges equal points, and points on a line give no face; both are errors.
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

    /// Returns a counter-clockwise square from `low` to `high`.
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
        let loops = [square(0.0, 4.0), hole(1.0, 2.0)];
        let faces = constrained_delaunay(&loops).expect("a ring");
        assert_eq!(faces.len(), 8);
        assert!((area(&loops.concat(), &faces) - 15.0).abs() < 1e-12);
    }

    #[test]
    fn a_cut_open_ring_is_a_disc() {
        let corners = square(0.0, 4.0);
        let inner = hole(1.0, 2.0);
        let mut outline = vec![corners[0]];
        outline.extend([3, 0, 1, 2, 3].map(|k| inner[k]));
        outline.extend([0, 1, 2, 3].map(|k| corners[k]));
        let faces = constrained_delaunay(std::slice::from_ref(&outline)).expect("a slit");
        assert_eq!(faces.len() + 2, outline.len());
        assert!((area(&outline, &faces) - 15.0).abs() < 1e-12);
        let fine = RefinementOptions {
            max_edge: Some(0.3),
            max_points: 1000,
        };
        let mesh =
            refined_delaunay(std::slice::from_ref(&outline), &fine, &Silent).expect("a slit");
        assert_eq!(mesh.points[..outline.len()], outline);
        assert!((area(&mesh.points, &mesh.faces) - 15.0).abs() < 1e-9);
        assert_eq!(mesh.faces.len() + outline.len() + 2, 2 * mesh.points.len());
    }

    #[test]
    fn refinement_preserves_the_boundary() {
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
    fn loops_that_do_not_bound_one_piece_are_rejected() {
        let error_of = |loops: &[Vec<DVec2>]| constrained_delaunay(loops).expect_err("no piece");
        let bow = points([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(error_of(&[bow]), TriangulationError::NotSimple);
        let twice = points([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 1.0)]);
        assert_eq!(error_of(&[twice]), TriangulationError::NotSimple);
        let nan = vec![DVec2::ZERO, DVec2::X, DVec2::NAN];
        assert_eq!(error_of(&[nan]), TriangulationError::OutOfRange);
        let not_one = TriangulationError::NotOnePiece;
        assert_eq!(error_of(&[hole(0.0, 1.0)]), not_one);
        assert_eq!(error_of(&[square(0.0, 1.0), hole(2.0, 3.0)]), not_one);
        assert_eq!(error_of(&[square(0.0, 1.0), square(2.0, 3.0)]), not_one);
        assert_eq!(error_of(&[hole(1.0, 2.0), square(0.0, 4.0)]), not_one);
        let nested = [square(0.0, 9.0), hole(1.0, 8.0), hole(2.0, 3.0)];
        assert_eq!(error_of(&nested), not_one);
        let touching = [square(0.0, 4.0), hole(0.0, 1.0)];
        assert_eq!(error_of(&touching), TriangulationError::NotSimple);
    }

    #[test]
    fn an_hourglass_is_rejected_as_two_pieces() {
        let waist = (1.0, 1.0);
        let glass = points([(0.0, 0.0), (2.0, 0.0), waist, (2.0, 2.0), (0.0, 2.0), waist]);
        assert!(constrained_delaunay(&[glass]).is_err());
    }
}
