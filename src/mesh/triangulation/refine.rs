//! Delaunay refinement that splits no edge of the boundary (Chew 1993, Ruppert 1995): inserts the
//! circumcentres of bad faces, largest circumcircle first, unless they lie beyond the boundary or
//! too close to it.

use super::domain::{ConstrainedDelaunay, TriangulationDomain};
use crate::geometry::{Bounds, DVec2, orient2d};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use spade::handles::{DirectedEdgeHandle, FaceHandle, FixedVertexHandle, InnerTag};
use spade::{Point2, Triangulation as _};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashSet};

/// Directed edge of the library's triangulation.
type SpadeEdge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), spade::CdtEdge<()>, ()>;
/// Inner face of the library's triangulation.
type SpadeFace<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), spade::CdtEdge<()>, ()>;

/// Fineness of a triangulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinementOptions {
    /// Approximate maximum edge length; with `None`, faces are refined only for their angles.
    pub max_edge: Option<f64>,
    /// Maximum number of points to add.
    pub max_points: usize,
}

/// Minimum angle of a face that refinement aims for, in radians: 23°. Refinement terminates for
/// values up to about 0.5; close to that, it adds many points for little improvement (heuristic).
const MIN_ANGLE: f64 = 0.4;

/// Minimum area of a face that is refined, as a fraction of the area of the piece's bounding square
/// (tolerance: below about 1e-15, rounding dominates the circumcentre).
const MIN_AREA_FRACTION: f64 = 1e-14;

/// Priority of a bad face: its squared circumradius, then its vertices, so that the order is always
/// unique. The squared circumradius is stored as its bits, which sort like the non-negative number
/// itself.
type BadFaceRank = (u64, Reverse<[FixedVertexHandle; 3]>);

/// Limits beyond which a face is bad: too large, or with too small an angle.
struct FaceLimits {
    /// A face is bad if the square of its shortest edge, divided by the square of its circumradius,
    /// is below this limit.
    ratio: f64,
    /// A face is bad if its area exceeds this limit.
    area: f64,
    /// Area below which a face is never refined.
    least_area: f64,
}

impl TriangulationDomain {
    /// Inserts points until no bad face (too large, or with too small an angle) can be improved, or
    /// until the maximum number of points is reached.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    pub(super) fn refine(
        &mut self,
        refinement: &RefinementOptions,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        let limits = self.limits(refinement);
        let winding = self.winding();
        let mut bad: BTreeMap<BadFaceRank, DVec2> = self
            .delaunay
            .inner_faces()
            .filter(|face| winding[face.index()] == 1)
            .filter_map(|face| limits.judge(face))
            .collect();
        let mut added = 0;
        while added < refinement.max_points
            && let Some(((_, Reverse(vertices)), centre)) = bad.pop_last()
        {
            check_cancelled(progress)?;
            // A face that cannot be improved does not return to the queue of bad faces, because
            // only faces at new vertices enter this queue.
            let Some(vertex) = insert(&mut self.delaunay, vertices, centre) else {
                continue;
            };
            added += 1;
            let new = self.delaunay.vertex(vertex).out_edges();
            let faces = new.filter_map(|edge| edge.face().as_inner());
            bad.extend(faces.filter_map(|face| limits.judge(face)));
        }
        Ok(())
    }

    /// Converts the options to limits for faces.
    fn limits(&self, refinement: &RefinementOptions) -> FaceLimits {
        let positions = self.delaunay.vertices().map(|v| at(v.position()));
        let size = Bounds::of(positions).map_or(0.0, |bounds| bounds.size().max_element());
        let least_area = MIN_AREA_FRACTION * size * size;
        let equilateral = |edge: f64| (0.25 * 3f64.sqrt() * edge * edge).max(least_area);
        FaceLimits {
            // The smallest angle α is opposite the shortest edge l, and l = 2 R sin α with the
            // circumradius R.
            ratio: (2.0 * MIN_ANGLE.sin()).powi(2),
            area: refinement.max_edge.map_or(f64::INFINITY, equilateral),
            least_area,
        }
    }
}

impl FaceLimits {
    /// Returns the priority and the circumcentre of a face; `None` if the face is not bad.
    fn judge(&self, face: SpadeFace<'_>) -> Option<(BadFaceRank, DVec2)> {
        let area = face.area();
        if area <= self.least_area {
            return None;
        }
        let (centre, radius_squared) = face.circumcircle();
        let shortest = face
            .adjacent_edges()
            .map(|edge| edge.length_2())
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let bad = shortest < self.ratio * radius_squared || area > self.area;
        let vertices = face.vertices().map(|v| v.fix());
        let rank = (radius_squared.to_bits(), Reverse(vertices));
        bad.then(|| (rank, at(centre)))
    }
}

/// Inserts a vertex at the circumcentre of the face `[a, b, c]`, if the face still exists and the
/// circumcentre lies inside the piece and not too close to the piece's boundary.
fn insert(
    delaunay: &mut ConstrainedDelaunay,
    [a, b, c]: [FixedVertexHandle; 3],
    centre: DVec2,
) -> Option<FixedVertexHandle> {
    // Vertices that were inserted after the face entered the queue may have removed the face.
    let edge = delaunay.get_edge_from_neighbors(a, b)?;
    let face = edge.face().as_inner()?;
    if !face.vertices().iter().any(|v| v.fix() == c) || !is_free(face, centre) {
        return None;
    }
    // If there is a vertex at this point already, the library returns it and inserts none.
    let before = delaunay.num_vertices();
    let vertex = delaunay
        .insert_with_hint(Point2::new(centre.x, centre.y), c)
        .ok()?;
    (delaunay.num_vertices() > before).then_some(vertex)
}

/// Returns whether a face's circumcentre lies inside the piece, and outside the diametral circle of
/// every boundary edge near it.
fn is_free(face: SpadeFace<'_>, centre: DVec2) -> bool {
    let mut visited: HashSet<usize> = HashSet::from([face.index()]);
    let mut pending = vec![face];
    let mut is_inside = false;
    while let Some(face) = pending.pop() {
        // Visit the faces that the insertion would remove. One of them contains the new point,
        // unless the point lies beyond a boundary edge.
        let contains_point = face.adjacent_edges().iter().all(|edge| sees(*edge, centre));
        is_inside |= contains_point;
        for edge in face.adjacent_edges() {
            if edge.is_constraint_edge() {
                if encroaches(edge, centre) {
                    return false;
                }
                continue;
            }
            if let Some(across) = edge.rev().face().as_inner()
                && !visited.contains(&across.index())
                && in_circle(across, centre)
            {
                visited.insert(across.index());
                pending.push(across);
            }
        }
    }
    is_inside
}

/// Converts a point of the triangulation library.
fn at(p: Point2<f64>) -> DVec2 {
    DVec2::new(p.x, p.y)
}

/// Returns whether a point lies to the left of an edge, where its face is, or on the edge's line.
fn sees(edge: SpadeEdge<'_>, p: DVec2) -> bool {
    let [a, b] = edge.positions().map(at);
    orient2d(a, b, p) >= 0.0
}

/// Returns whether a point lies in the diametral circle of an edge.
fn encroaches(edge: SpadeEdge<'_>, p: DVec2) -> bool {
    let [a, b] = edge.positions().map(at);
    (a - p).dot(b - p) <= 0.0
}

/// Returns whether a point lies in a face's circumcircle.
fn in_circle(face: SpadeFace<'_>, p: DVec2) -> bool {
    let (centre, radius_squared) = face.circumcircle();
    p.distance_squared(at(centre)) < radius_squared
}
