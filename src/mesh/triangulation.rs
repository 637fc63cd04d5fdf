//! Triangulation of one simple polygon: constrained Delaunay (Chew 1989),
//! plain or refined (Ruppert 1995). The only place that names `spade`.
//!
//! Guaranteed: the polygon's vertices come first and in order, faces are
//! strictly counter-clockwise by exact predicates and fill the polygon.
//! Not guaranteed: that a refinement reaches its angle; beside sharp corners
//! and unsplit edges none can. Nothing is checked about the polygon but what
//! the triangulation itself trips over.

use crate::geometry::DVec2;
use spade::handles::{FixedFaceHandle, InnerTag};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation as _,
};

/// How fine a triangulation is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Smallest angle wanted, in radians; up to about 0.5 it can be reached.
    pub min_angle: f64,
    /// Longest edge wanted, roughly; `None` leaves it to the angles.
    pub max_edge: Option<f64>,
    /// The most points that may be added.
    pub max_points: usize,
    /// Whether edges of the polygon may be split too.
    pub split_boundary: bool,
}

/// Points, the polygon's first, and counter-clockwise faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangulated {
    /// The polygon's vertices in order, then those that were added.
    pub points: Vec<DVec2>,
    /// Three indices into the points each.
    pub faces: Vec<[u32; 3]>,
}

/// Why a polygon was not triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TriangulationError {
    /// Fewer than three points.
    #[error("an outline needs at least 3 points, this one has {0}; add points")]
    TooFewPoints(usize),
    /// NaN, infinite or beyond the range of the arithmetic.
    #[error("a point of the outline is not finite or beyond 1e60; scale the design")]
    OutOfRange,
    /// Two edges cross, overlap, or two points coincide.
    #[error("the outline crosses or touches itself; repair it first")]
    NotSimple,
}

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// The constrained Delaunay triangulation without further points: n − 2
/// faces, in O(n log n).
///
/// # Errors
/// [`TriangulationError`] if the points make no simple polygon.
///
/// ```
/// use morphospace::{geometry::DVec2, mesh::triangulation::constrained_delaunay};
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
/// assert_eq!(constrained_delaunay(&square)?.len(), 2);
/// # Ok::<(), morphospace::mesh::triangulation::TriangulationError>(())
/// ```
pub fn constrained_delaunay(polygon: &[DVec2]) -> Result<Vec<[u32; 3]>, TriangulationError> {
    Ok(inner_faces(&delaunay(polygon)?))
}

/// The constrained Delaunay triangulation, refined.
///
/// # Errors
/// [`TriangulationError`] if the points make no simple polygon.
pub fn refined(
    polygon: &[DVec2],
    refinement: &Refinement,
) -> Result<Triangulated, TriangulationError> {
    let mut triangulation = delaunay(polygon)?;
    triangulation.refine(parameters(polygon, refinement));
    let points = triangulation
        .vertices()
        .map(|v| DVec2::new(v.position().x, v.position().y));
    Ok(Triangulated {
        points: points.collect(),
        faces: inner_faces(&triangulation),
    })
}

fn delaunay(polygon: &[DVec2]) -> Result<Delaunay, TriangulationError> {
    let n = polygon.len();
    if n < 3 {
        return Err(TriangulationError::TooFewPoints(n));
    }
    let points = polygon.iter().map(|p| Point2::new(tame(p.x), tame(p.y)));
    let edges = (0..n).map(|i| [i, (i + 1) % n]).collect();
    let mut conflict = false;
    let made = Delaunay::try_bulk_load_cdt(points.collect(), edges, |_| conflict = true)
        .map_err(|_| TriangulationError::OutOfRange)?;
    if conflict || made.num_vertices() != n || made.num_constraints() != n {
        return Err(TriangulationError::NotSimple);
    }
    Ok(made)
}

/// Coordinates below the arithmetic's range become zero.
fn tame(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        x
    }
}

/// Faces of less than this share of the bounding square stay as they are:
/// below some 1e-15 the centre of the circumcircle is rounding alone.
const SMALLEST_SHARE: f64 = 1e-10;

fn parameters(polygon: &[DVec2], refinement: &Refinement) -> RefinementParameters<f64> {
    let low = polygon.iter().copied().reduce(DVec2::min);
    let high = polygon.iter().copied().reduce(DVec2::max);
    let size = high.zip(low).map_or(0.0, |(h, l)| (h - l).max_element());
    let mut parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_rad(refinement.min_angle))
        .with_min_required_area(SMALLEST_SHARE * size * size)
        .with_max_additional_vertices(refinement.max_points);
    if let Some(edge) = refinement.max_edge {
        let equilateral = 0.25 * 3f64.sqrt() * edge * edge;
        parameters =
            parameters.with_max_allowed_area(equilateral.max(SMALLEST_SHARE * size * size));
    }
    if refinement.split_boundary {
        parameters
    } else {
        parameters.keep_constraint_edges()
    }
}

/// The faces that cannot be reached from outside without crossing an edge of
/// the polygon.
fn inner_faces(triangulation: &Delaunay) -> Vec<[u32; 3]> {
    let outside = outer_faces(triangulation);
    triangulation
        .inner_faces()
        .filter(|face| !outside[face.fix().index()])
        .map(|face| face.vertices().map(|v| v.fix().index() as u32))
        .collect()
}

fn outer_faces(triangulation: &Delaunay) -> Vec<bool> {
    let mut outside = vec![false; triangulation.num_all_faces()];
    let mut open: Vec<FixedFaceHandle<InnerTag>> = triangulation
        .convex_hull()
        .filter(|edge| !edge.is_constraint_edge())
        .filter_map(|edge| edge.rev().face().as_inner().map(|f| f.fix()))
        .collect();
    while let Some(handle) = open.pop() {
        if std::mem::replace(&mut outside[handle.index()], true) {
            continue;
        }
        let face = triangulation.face(handle);
        for edge in face.adjacent_edges() {
            if !edge.is_constraint_edge() {
                open.extend(edge.rev().face().as_inner().map(|f| f.fix()));
            }
        }
    }
    outside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{orient2d, twice_signed_area};

    fn u_shape() -> Vec<DVec2> {
        [
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ]
        .map(DVec2::from)
        .to_vec()
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
        let faces = constrained_delaunay(&u_shape()).expect("simple");
        assert_eq!(faces.len(), 6);
        assert!((area(&u_shape(), &faces) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn refinement_keeps_or_splits_the_boundary_as_asked() {
        for split_boundary in [false, true] {
            let refinement = Refinement {
                min_angle: 0.4,
                max_edge: Some(0.3),
                max_points: 1000,
                split_boundary,
            };
            let mesh = refined(&u_shape(), &refinement).expect("simple");
            assert_eq!(mesh.points[..8], u_shape());
            assert!(mesh.faces.len() > if split_boundary { 100 } else { 5 });
            assert!((area(&mesh.points, &mesh.faces) - 7.0).abs() < 1e-9);
            let on_bottom = mesh.points.iter().filter(|p| p.y == 0.0).count();
            assert_eq!(on_bottom > 2, split_boundary);
        }
    }

    #[test]
    fn what_is_no_simple_polygon_is_refused() {
        let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from);
        assert_eq!(
            constrained_delaunay(&bow),
            Err(TriangulationError::NotSimple)
        );
        let twice = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        assert_eq!(
            constrained_delaunay(&twice),
            Err(TriangulationError::NotSimple)
        );
        let nan = [DVec2::ZERO, DVec2::X, DVec2::NAN];
        assert_eq!(
            constrained_delaunay(&nan),
            Err(TriangulationError::OutOfRange)
        );
    }
}
