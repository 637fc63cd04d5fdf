//! A piece as a constrained Delaunay triangulation whose coincident points
//! are merged, and how it is cut open again along its walks.

use crate::geometry::DVec2;
use crate::mesh::{components, undirected};
use crate::work::progress::Cancelled;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};
use std::collections::{HashMap, HashSet};

/// Why a piece was not triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulationError {
    /// Fewer than three points.
    #[error("an outline needs at least 3 points, this one has {0}; add points")]
    TooFewPoints(usize),
    /// NaN, infinite or beyond the range of the arithmetic.
    #[error("a point of the outline is not finite or beyond 1e60; scale the design")]
    OutOfRange,
    /// Two edges cross or overlap, or points coincide beside no slit.
    #[error("the outline crosses or touches itself; repair it first")]
    NotSimple,
    /// The walks bound no single piece with holes.
    #[error(
        "the outlines bound no single piece; the outer one has to run counter-clockwise around all others, those clockwise and beside each other"
    )]
    NotOnePiece,
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

pub(super) type ConstrainedDelaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// No corner of a walk.
const NONE: u32 = u32::MAX;

/// The merged points before, at and after a corner of a walk.
type LoopCorner = [u32; 3];

pub(super) struct TriangulationDomain {
    pub(super) delaunay: ConstrainedDelaunay,
    merged: Vec<LoopCorner>,
    /// How many merged points there are; added ones follow them.
    fixed: usize,
    /// The walks' edges between merged points, as they are run: a slit's in
    /// both directions.
    walked: HashSet<[u32; 2]>,
}

impl TriangulationDomain {
    pub(super) fn of<W: AsRef<[DVec2]>>(walks: &[W]) -> Result<Self, TriangulationError> {
        let (points, merged) = merged_points(walks)?;
        let mut walked = HashSet::new();
        // Once each way: more would leave no wedge of the piece between them.
        let is_new = |&[_, a, b]: &LoopCorner| a != b && walked.insert([a, b]);
        if !merged.iter().all(is_new) {
            return Err(TriangulationError::NotSimple);
        }
        let mut edges: Vec<[usize; 2]> = (walked.iter())
            .map(|&edge| undirected(edge).map(|v| v as usize))
            .collect();
        // In order: hashing would make another triangulation on every run.
        edges.sort_unstable();
        edges.dedup();
        let (fixed, constraints) = (points.len(), edges.len());
        let mut conflict = false;
        let delaunay = ConstrainedDelaunay::try_bulk_load_cdt(points, edges, |_| conflict = true)
            .map_err(|_| TriangulationError::OutOfRange)?;
        // Crossings are conflicts; edges along each other change the count.
        if conflict
            || delaunay.num_vertices() != fixed
            || delaunay.num_constraints() != constraints
            || delaunay.num_inner_faces() == 0
        {
            return Err(TriangulationError::NotSimple);
        }
        let domain = Self {
            delaunay,
            merged,
            fixed,
            walked,
        };
        let edges = domain.delaunay.undirected_edges();
        let mut kept = (edges.filter(|edge| edge.is_constraint_edge()))
            .map(|edge| edge.vertices().map(|v| v.index() as u32));
        // A point on an edge has cut it in two, and neither half was walked.
        let was_walked = |way: [u32; 2]| domain.walked.contains(&way);
        if kept.any(|[a, b]| !was_walked([a, b]) && !was_walked([b, a])) {
            return Err(TriangulationError::NotSimple);
        }
        domain.check(walks[0].as_ref().len())?;
        Ok(domain)
    }

    /// The walks' corners, then the added points.
    pub(super) fn points<W: AsRef<[DVec2]>>(&self, walks: &[W]) -> Vec<DVec2> {
        let corners = walks.iter().flat_map(|w| w.as_ref().iter().copied());
        let added = self.delaunay.vertices().skip(self.fixed);
        corners
            .chain(added.map(|v| DVec2::new(v.position().x, v.position().y)))
            .collect()
    }

    /// Whether the walks bound one piece, the first from outside.
    fn check(&self, outer: usize) -> Result<(), TriangulationError> {
        let winding = self.winding();
        // The first face is the outer one.
        if winding[1..].iter().any(|w| !(0..=1).contains(w)) {
            return Err(TriangulationError::NotOnePiece);
        }
        // What no corner refuses is labelled all: every wedge of the piece
        // begins at an edge by which some walk leaves.
        self.corners(&winding)
            .ok_or(TriangulationError::NotSimple)?;
        // No hole reaches as far left as the outline does.
        let places = self.delaunay.vertices().map(|v| v.position()).enumerate();
        let first = places.min_by(|(_, a), (_, b)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let first = first.map_or(NONE, |(v, _)| v as u32);
        let mut outer = self.merged[..outer].iter();
        if !outer.any(|corner| corner[1] == first) || !self.is_connected(&winding) {
            return Err(TriangulationError::NotOnePiece);
        }
        Ok(())
    }

    /// For each face how often the walks run around it.
    pub(super) fn winding(&self) -> Vec<i32> {
        const UNKNOWN: i32 = i32::MAX;
        let mut winding = vec![UNKNOWN; self.delaunay.num_all_faces()];
        winding[self.delaunay.outer_face().index()] = 0;
        // Edges with a face on their left that is known: the hull's have the
        // outer one there.
        let mut open: Vec<_> = self.delaunay.convex_hull().collect();
        while let Some(edge) = open.pop() {
            let beyond = edge.rev().face();
            if winding[beyond.index()] != UNKNOWN {
                continue;
            }
            let [a, b] = edge.vertices().map(|v| v.index() as u32);
            let runs = |way: [u32; 2]| i32::from(self.walked.contains(&way));
            // A walk goes once more around what is on its left.
            winding[beyond.index()] = winding[edge.face().index()] - runs([a, b]) + runs([b, a]);
            let inner = beyond.as_inner().into_iter();
            open.extend(inner.flat_map(|face| face.adjacent_edges()));
        }
        winding
    }

    fn is_connected(&self, winding: &[i32]) -> bool {
        let edges = self.delaunay.undirected_edges();
        let free = edges.filter(|edge| !edge.is_constraint_edge());
        let across = free.map(|edge| {
            let edge = edge.as_directed();
            [edge, edge.rev()].map(|side| side.face().index() as u32)
        });
        let part = components(winding.len(), across);
        let mut inside = part.iter().zip(winding).filter(|(_, w)| **w == 1);
        let first = inside.next();
        first.is_some_and(|(first, _)| inside.all(|(other, _)| other == first))
    }

    /// For each face which corners of the walks stand at its vertices; `None`
    /// if a walk's two edges at a corner do not bound one wedge of the piece.
    fn corners(&self, winding: &[i32]) -> Option<Vec<[u32; 3]>> {
        let mut corners = vec![[NONE; 3]; winding.len()];
        for (corner, points) in (0..).zip(&self.merged) {
            let [before, here, after] = points.map(|v| FixedVertexHandle::from_index(v as usize));
            let mut edge = self.delaunay.get_edge_from_neighbors(here, after)?;
            // Counter-clockwise from the walk's next edge to its previous one
            // lies the piece, since that is on the left of its walks.
            loop {
                let face = edge.face().as_inner()?;
                let k = (0..3).find(|&k| face.vertices()[k].fix() == here)?;
                let place = &mut corners[face.index()][k];
                if winding[face.index()] != 1 || *place != NONE {
                    return None;
                }
                *place = corner;
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

    /// The faces of the piece by corners of the walks and added points.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        let winding = self.winding();
        // Some: they were checked, and a refinement cuts no edge of a walk.
        let corners = self.corners(&winding).unwrap_or_default();
        let count = self.merged.len();
        let numbered = |v: usize, corner: u32| {
            if v < self.fixed {
                corner
            } else {
                (v - self.fixed + count) as u32
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

/// Different points, and which of them each corner has.
fn merged_points<W: AsRef<[DVec2]>>(
    walks: &[W],
) -> Result<(Vec<Point2<f64>>, Vec<LoopCorner>), TriangulationError> {
    let least = walks.iter().map(|w| w.as_ref().len()).min().unwrap_or(0);
    if least < 3 {
        return Err(TriangulationError::TooFewPoints(least));
    }
    let mut numbers: HashMap<[u64; 2], u32> = HashMap::new();
    let mut points = Vec::new();
    let mut number = |p: &DVec2| {
        let [x, y] = p.to_array().map(tame);
        *numbers
            .entry([x.to_bits(), y.to_bits()])
            .or_insert_with(|| {
                points.push(Point2::new(x, y));
                points.len() as u32 - 1
            })
    };
    let mut merged = Vec::new();
    for walk in walks {
        let own: Vec<u32> = walk.as_ref().iter().map(&mut number).collect();
        let n = own.len();
        merged.extend((0..n).map(|i| [own[(i + n - 1) % n], own[i], own[(i + 1) % n]]));
    }
    Ok((points, merged))
}

/// Coordinates below the arithmetic's range become zero, as negative zero
/// does.
fn tame(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        x
    }
}
