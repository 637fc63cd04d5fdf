//! Delaunay refinement that splits no edge of the boundary (Chew 1993,
//! Ruppert 1995): circumcentres of bad faces, largest circle first, unless
//! they lie beyond the boundary or too near to it.

use super::domain::{ConstrainedDelaunay, TriangulationDomain};
use crate::geometry::{Bounds, DVec2, orient2d};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use spade::handles::{DirectedEdgeHandle, FaceHandle, FixedVertexHandle, InnerTag};
use spade::{Point2, Triangulation as _};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashSet};

type SpadeEdge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), spade::CdtEdge<()>, ()>;
type SpadeFace<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), spade::CdtEdge<()>, ()>;

/// How fine a triangulation is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinementOptions {
    /// Longest edge wanted, roughly; `None` leaves it to the angles.
    pub max_edge: Option<f64>,
    /// The most points that may be added.
    pub max_points: usize,
}

/// Smallest angle wanted, in radians: 23°. Up to about 0.5 it can be reached;
/// nearer to that, points are spent on little.
const MIN_ANGLE: f64 = 0.4;

/// Faces of less than this share of the bounding square stay as they are:
/// below some 1e-15 the centre of the circumcircle is rounding alone.
const SMALLEST_SHARE: f64 = 1e-14;

/// A face's place among the bad ones: the bits of its circumcircle's squared
/// radius, which order as it does since it is not negative, and its vertices,
/// so that of equal circles one is always the first.
type BadFaceRank = (u64, Reverse<[FixedVertexHandle; 3]>);

/// What makes a face bad.
struct FaceLimits {
    /// Least squared ratio of the shortest edge to the circumradius.
    ratio: f64,
    area: f64,
    least_area: f64,
}

impl TriangulationDomain {
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
            still_wanted(progress)?;
            // A face that cannot be bettered is not asked again: only faces at
            // new vertices come into the queue.
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

    fn limits(&self, refinement: &RefinementOptions) -> FaceLimits {
        let positions = self.delaunay.vertices().map(|v| at(v.position()));
        let size = Bounds::of(positions).map_or(0.0, |bounds| bounds.size().max_element());
        let least_area = SMALLEST_SHARE * size * size;
        let equilateral = |edge: f64| (0.25 * 3f64.sqrt() * edge * edge).max(least_area);
        FaceLimits {
            // The least angle α lies opposite the shortest side l: l = 2 R sin α.
            ratio: (2.0 * MIN_ANGLE.sin()).powi(2),
            area: refinement.max_edge.map_or(f64::INFINITY, equilateral),
            least_area,
        }
    }
}

impl FaceLimits {
    /// The rank of a bad face, and its circumcentre.
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

/// Puts a vertex into a circumcentre, if the face is still there and the
/// place is inside and no nearer to the boundary than half its edge.
fn insert(
    delaunay: &mut ConstrainedDelaunay,
    [a, b, c]: [FixedVertexHandle; 3],
    centre: DVec2,
) -> Option<FixedVertexHandle> {
    // Insertions since it was judged may have taken the face away.
    let edge = delaunay.get_edge_from_neighbors(a, b)?;
    let face = edge.face().as_inner()?;
    if !face.vertices().iter().any(|v| v.fix() == c) || !is_free(face, centre) {
        return None;
    }
    // On a point that is there, the library gives that one back.
    let before = delaunay.num_vertices();
    let vertex = delaunay
        .insert_with_hint(Point2::new(centre.x, centre.y), c)
        .ok()?;
    (delaunay.num_vertices() > before).then_some(vertex)
}

/// Whether no edge of the boundary that a new point's faces would meet hides
/// the point or has it in its diametral circle.
fn is_free(face: SpadeFace<'_>, centre: DVec2) -> bool {
    let mut seen: HashSet<usize> = HashSet::from([face.index()]);
    let mut open = vec![face];
    let mut reached = false;
    while let Some(face) = open.pop() {
        // The faces that the point will take away: one of them holds it, or it
        // lies behind an edge of the boundary.
        let inside = face.adjacent_edges().iter().all(|edge| sees(*edge, centre));
        reached |= inside;
        for edge in face.adjacent_edges() {
            if edge.is_constraint_edge() {
                if encroaches(edge, centre) {
                    return false;
                }
                continue;
            }
            if let Some(beyond) = edge.rev().face().as_inner()
                && !seen.contains(&beyond.index())
                && in_circle(beyond, centre)
            {
                seen.insert(beyond.index());
                open.push(beyond);
            }
        }
    }
    reached
}

fn at(p: Point2<f64>) -> DVec2 {
    DVec2::new(p.x, p.y)
}

/// Whether a point is on the face's side of an edge, or on it.
fn sees(edge: SpadeEdge<'_>, p: DVec2) -> bool {
    let [a, b] = edge.positions().map(at);
    orient2d(a, b, p) >= 0.0
}

fn encroaches(edge: SpadeEdge<'_>, p: DVec2) -> bool {
    let [a, b] = edge.positions().map(at);
    (a - p).dot(b - p) <= 0.0
}

fn in_circle(face: SpadeFace<'_>, p: DVec2) -> bool {
    let (centre, radius_squared) = face.circumcircle();
    p.distance_squared(at(centre)) < radius_squared
}
