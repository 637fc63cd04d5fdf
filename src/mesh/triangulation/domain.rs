//! Constrained Delaunay triangulation of a connected region (piece). Coinciding corners of its
//! loops, such as those on both sides of a slit, are merged for the triangulation. The resulting
//! faces again have one vertex for each corner of a loop.

use crate::geometry::DVec2;
use crate::mesh::{components, undirected};
use crate::work::progress::Cancelled;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};
use std::collections::{HashMap, HashSet};

/// Reason why a piece cannot be triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulationError {
    /// A loop has fewer than three points.
    #[error("an outline needs at least 3 points, this one has {0}; add points")]
    TooFewPoints(usize),
    /// A coordinate is NaN, infinite, or larger than the triangulation library allows.
    #[error("a point of the outline is not finite or beyond 1e60; correct it or scale the design")]
    OutOfRange,
    /// Two edges cross or overlap, or points coincide other than along a slit.
    #[error("the outline crosses or touches itself; repair it first")]
    NotSimple,
    /// The loops do not bound one connected piece with holes.
    #[error(
        "the outlines do not bound one connected piece; the outer one must run counter-clockwise around all others, and those clockwise without enclosing each other"
    )]
    NotOnePiece,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The library's constrained Delaunay triangulation.
pub(super) type ConstrainedDelaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Stands for "no loop corner" at a vertex of a face, and for "no vertex".
const NONE: u32 = u32::MAX;

/// Corner of a loop as three points: the one before the corner, the corner itself and the one after
/// it. Each is an index into the distinct points of all loops.
type LoopCorner = [u32; 3];

/// A connected piece as a constrained Delaunay triangulation of its distinct points.
pub(super) struct TriangulationDomain {
    pub(super) delaunay: ConstrainedDelaunay,
    /// Corners of all loops, one loop after another, with coinciding corners merged to one point.
    merged: Vec<LoopCorner>,
    /// Number of distinct points of the loops; points added by refinement follow them in
    /// `delaunay`.
    point_count: usize,
    /// Directed edges of the loops, as pairs of indices of distinct points. Edges along a slit
    /// occur in both directions.
    directed_edges: HashSet<[u32; 2]>,
}

impl TriangulationDomain {
    /// Triangulates the piece bounded by the loops, the outer one first.
    ///
    /// # Errors
    /// [`TriangulationError`] if the loops do not bound one connected piece.
    pub(super) fn of<W: AsRef<[DVec2]>>(loops: &[W]) -> Result<Self, TriangulationError> {
        let (points, merged) = merged_points(loops)?;
        let mut directed_edges = HashSet::new();
        // Each directed edge may occur only once, because the piece has no area between two edges
        // with the same ends and direction.
        let is_new = |&[_, a, b]: &LoopCorner| a != b && directed_edges.insert([a, b]);
        if !merged.iter().all(is_new) {
            return Err(TriangulationError::NotSimple);
        }
        let mut edges: Vec<[usize; 2]> = (directed_edges.iter())
            .map(|&edge| undirected(edge).map(|v| v as usize))
            .collect();
        // Sort the edges, because the order of a hash set would make results differ between runs.
        edges.sort_unstable();
        edges.dedup();
        let (point_count, constraint_count) = (points.len(), edges.len());
        let mut has_conflict = false;
        let delaunay =
            ConstrainedDelaunay::try_bulk_load_cdt(points, edges, |_| has_conflict = true)
                .map_err(|_| TriangulationError::OutOfRange)?;
        // Crossing edges are conflicts; overlapping edges change the number of constraints.
        if has_conflict
            || delaunay.num_vertices() != point_count
            || delaunay.num_constraints() != constraint_count
            || delaunay.num_inner_faces() == 0
        {
            return Err(TriangulationError::NotSimple);
        }
        let domain = Self {
            delaunay,
            merged,
            point_count,
            directed_edges,
        };
        let edges = domain.delaunay.undirected_edges();
        let mut constraint_edges = (edges.filter(|edge| edge.is_constraint_edge()))
            .map(|edge| edge.vertices().map(|v| v.index() as u32));
        // If a point lies on an edge, the library divides the edge into two that are not edges of
        // any loop.
        let is_loop_edge = |edge: [u32; 2]| domain.directed_edges.contains(&edge);
        if constraint_edges.any(|[a, b]| !is_loop_edge([a, b]) && !is_loop_edge([b, a])) {
            return Err(TriangulationError::NotSimple);
        }
        domain.check(loops[0].as_ref().len())?;
        Ok(domain)
    }

    /// Returns the positions of the loops' corners, then those of the points added by refinement.
    pub(super) fn points<W: AsRef<[DVec2]>>(&self, loops: &[W]) -> Vec<DVec2> {
        let corners = loops.iter().flat_map(|w| w.as_ref().iter().copied());
        let added = self.delaunay.vertices().skip(self.point_count);
        corners
            .chain(added.map(|v| DVec2::new(v.position().x, v.position().y)))
            .collect()
    }

    /// Checks that the loops bound one connected piece, and that the first loop, with `outer`
    /// corners, is its outer boundary.
    ///
    /// # Errors
    /// [`TriangulationError`] if they do not.
    fn check(&self, outer: usize) -> Result<(), TriangulationError> {
        let winding = self.winding();
        // Face 0 is the outer face.
        if winding[1..].iter().any(|w| !(0..=1).contains(w)) {
            return Err(TriangulationError::NotOnePiece);
        }
        // `corners` fails unless the two loop edges at every loop corner bound one sector of the
        // piece (the faces around the corner between these edges), and each sector belongs to one
        // loop corner. If it succeeds, every corner of every face in the piece has its loop corner,
        // because each sector begins at a loop edge.
        self.corners(&winding)
            .ok_or(TriangulationError::NotSimple)?;
        // The leftmost point belongs to the outer boundary, so it must be a corner of the first
        // loop.
        let positions = self.delaunay.vertices().map(|v| v.position()).enumerate();
        let leftmost =
            positions.min_by(|(_, a), (_, b)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let leftmost = leftmost.map_or(NONE, |(v, _)| v as u32);
        let mut outer = self.merged[..outer].iter();
        if !outer.any(|corner| corner[1] == leftmost) || !self.is_connected(&winding) {
            return Err(TriangulationError::NotOnePiece);
        }
        Ok(())
    }

    /// Returns the winding number of the loops around each face, by the face's index.
    pub(super) fn winding(&self) -> Vec<i32> {
        /// Marks faces that were not visited yet.
        const UNKNOWN: i32 = i32::MAX;
        let mut winding = vec![UNKNOWN; self.delaunay.num_all_faces()];
        winding[self.delaunay.outer_face().index()] = 0;
        // Edges for which the winding number of the face on the left is known. At first these are
        // the edges of the convex hull, with the outer face on their left.
        let mut pending: Vec<_> = self.delaunay.convex_hull().collect();
        while let Some(edge) = pending.pop() {
            let across = edge.rev().face();
            if winding[across.index()] != UNKNOWN {
                continue;
            }
            let [a, b] = edge.vertices().map(|v| v.index() as u32);
            let count = |direction: [u32; 2]| i32::from(self.directed_edges.contains(&direction));
            // The winding number is larger by one on the left of a loop's edge than on its right.
            winding[across.index()] = winding[edge.face().index()] - count([a, b]) + count([b, a]);
            let inner = across.as_inner().into_iter();
            pending.extend(inner.flat_map(|face| face.adjacent_edges()));
        }
        winding
    }

    /// Returns whether the faces with winding number 1 are connected across edges that are not on a
    /// loop.
    fn is_connected(&self, winding: &[i32]) -> bool {
        let edges = self.delaunay.undirected_edges();
        let unconstrained = edges.filter(|edge| !edge.is_constraint_edge());
        let across = unconstrained.map(|edge| {
            let edge = edge.as_directed();
            [edge, edge.rev()].map(|side| side.face().index() as u32)
        });
        let component = components(winding.len(), across);
        let mut inside = component.iter().zip(winding).filter(|(_, w)| **w == 1);
        let first = inside.next();
        first.is_some_and(|(first, _)| inside.all(|(other, _)| other == first))
    }

    /// Returns for each face the indices of the loop corners at its three vertices. The index is
    /// [`NONE`] at a vertex that refinement added, and for all faces outside the piece. Returns
    /// `None` unless the two loop edges at every loop corner bound one sector of the piece (the
    /// faces around the corner between these edges), and each sector belongs to one loop corner.
    fn corners(&self, winding: &[i32]) -> Option<Vec<[u32; 3]>> {
        let mut corners = vec![[NONE; 3]; winding.len()];
        for (corner, points) in (0..).zip(&self.merged) {
            let [before, here, after] = points.map(|v| FixedVertexHandle::from_index(v as usize));
            let mut edge = self.delaunay.get_edge_from_neighbors(here, after)?;
            // The piece lies on the left of its loops. Visit its faces around the corner
            // counter-clockwise, from the outgoing edge to the incoming edge.
            loop {
                let face = edge.face().as_inner()?;
                let k = (0..3).find(|&k| face.vertices()[k].fix() == here)?;
                let slot = &mut corners[face.index()][k];
                if winding[face.index()] != 1 || *slot != NONE {
                    return None;
                }
                *slot = corner;
                edge = edge.ccw();
                if edge.is_constraint_edge() {
                    break;
                }
            }
            if edge.to().fix() != before {
                return None;
            }
        }
        Some(corners)
    }

    /// Returns the faces of the piece. The vertices are numbered in this order: the corners of all
    /// loops, then the points added by refinement.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        let winding = self.winding();
        // Always `Some`: the corners were checked, and refinement splits no loop edge.
        let corners = self.corners(&winding).unwrap_or_default();
        let count = self.merged.len();
        let numbered = |v: usize, corner: u32| {
            if v < self.point_count {
                corner
            } else {
                (v - self.point_count + count) as u32
            }
        };
        self.delaunay
            .inner_faces()
            .filter(|face| winding[face.index()] == 1)
            .map(|face| {
                let [a, b, c] = face.vertices().map(|v| v.index());
                let [i, j, k] = corners[face.index()];
                [numbered(a, i), numbered(b, j), numbered(c, k)]
            })
            .collect()
    }
}

/// Returns the distinct points of all loops. Also returns, for each loop corner, the indices of
/// three points: the one before the corner, the corner itself and the one after it.
fn merged_points<W: AsRef<[DVec2]>>(
    loops: &[W],
) -> Result<(Vec<Point2<f64>>, Vec<LoopCorner>), TriangulationError> {
    let fewest = loops.iter().map(|w| w.as_ref().len()).min().unwrap_or(0);
    if fewest < 3 {
        return Err(TriangulationError::TooFewPoints(fewest));
    }
    let mut numbers: HashMap<[u64; 2], u32> = HashMap::new();
    let mut points = Vec::new();
    let mut number = |p: &DVec2| {
        let [x, y] = p.to_array().map(flush_to_zero);
        *numbers
            .entry([x.to_bits(), y.to_bits()])
            .or_insert_with(|| {
                points.push(Point2::new(x, y));
                points.len() as u32 - 1
            })
    };
    let mut merged = Vec::new();
    for outline in loops {
        let indices: Vec<u32> = outline.as_ref().iter().map(&mut number).collect();
        let n = indices.len();
        merged.extend((0..n).map(|i| [indices[(i + n - 1) % n], indices[i], indices[(i + 1) % n]]));
    }
    Ok((points, merged))
}

/// Replaces a coordinate by zero if it is negative zero, or smaller in absolute value than the
/// triangulation library allows.
fn flush_to_zero(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        x
    }
}
