//! A piece as a constrained Delaunay triangulation whose coincident points
//! are merged, and how it is cut open again along its walks.

use crate::geometry::DVec2;
use crate::mesh::components;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};
use std::collections::HashMap;

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
}

pub(super) type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// No corner of a walk.
const NONE: u32 = u32::MAX;

pub(super) struct Domain {
    pub(super) delaunay: Delaunay,
    /// For each corner of the walks its merged point.
    merged: Vec<u32>,
    /// For each corner the next and the previous one.
    next: Vec<u32>,
    previous: Vec<u32>,
    /// How many merged points there are; added ones follow them.
    fixed: usize,
    /// For each edge between merged points, smaller first, how often walks
    /// run along it upwards less downwards: 0 for a slit.
    net: HashMap<[u32; 2], i32>,
}

impl Domain {
    pub(super) fn of<W: AsRef<[DVec2]>>(walks: &[W]) -> Result<Self, TriangulationError> {
        let (points, merged) = merged_points(walks)?;
        let (next, previous) = neighbours(walks);
        let net = net_edges(&merged, &next)?;
        let mut edges: Vec<[usize; 2]> = net.keys().map(|e| e.map(|v| v as usize)).collect();
        edges.sort_unstable();
        let (fixed, constraints) = (points.len(), edges.len());
        let mut conflict = false;
        let delaunay = Delaunay::try_bulk_load_cdt(points, edges, |_| conflict = true)
            .map_err(|_| TriangulationError::OutOfRange)?;
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
            next,
            previous,
            fixed,
            net,
        };
        // A point on an edge would have cut it in two.
        let given = |edge: &[u32; 2]| domain.net.contains_key(edge);
        if !domain.constraints().all(|edge| given(&edge)) {
            return Err(TriangulationError::NotSimple);
        }
        domain.check(walks[0].as_ref().len())?;
        Ok(domain)
    }

    fn constraints(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let edges = self.delaunay.undirected_edges();
        let constraints = edges.filter(|edge| edge.is_constraint_edge());
        constraints.map(|edge| {
            let [a, b] = edge.vertices().map(|v| v.index() as u32);
            [a.min(b), a.max(b)]
        })
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
        if winding[1..].iter().any(|w| !(0..=1).contains(w)) {
            return Err(TriangulationError::NotOnePiece);
        }
        let corners = self
            .corners(&winding)
            .ok_or(TriangulationError::NotSimple)?;
        let places = self.delaunay.vertices().map(|v| v.position()).enumerate();
        let first = places.min_by(|(_, a), (_, b)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let first = first.map_or(NONE, |(v, _)| v as u32);
        if !self.merged[..outer].contains(&first) || !self.is_connected(&winding) {
            return Err(TriangulationError::NotOnePiece);
        }
        let unlabelled = |f: usize| winding[f] == 1 && corners[f].contains(&NONE);
        if (1..winding.len()).any(unlabelled) {
            return Err(TriangulationError::NotSimple);
        }
        Ok(())
    }

    /// How often the walks run from `a` to `b` less back.
    fn net(&self, a: u32, b: u32) -> i32 {
        match self.net.get(&[a.min(b), a.max(b)]) {
            None => 0,
            Some(&net) if a < b => net,
            Some(&net) => -net,
        }
    }

    /// For each face how often the walks run around it.
    pub(super) fn winding(&self) -> Vec<i32> {
        const UNKNOWN: i32 = i32::MAX;
        let mut winding = vec![UNKNOWN; self.delaunay.num_all_faces()];
        let outer = self.delaunay.outer_face();
        winding[outer.index()] = 0;
        let mut open = Vec::new();
        for edge in self.delaunay.convex_hull() {
            // The outer face is to its left.
            let (a, b) = (edge.from().index() as u32, edge.to().index() as u32);
            if let Some(face) = edge.rev().face().as_inner() {
                winding[face.index()] = -self.net(a, b);
                open.push(face);
            }
        }
        while let Some(face) = open.pop() {
            for edge in face.adjacent_edges() {
                let (a, b) = (edge.from().index() as u32, edge.to().index() as u32);
                if let Some(beyond) = edge.rev().face().as_inner()
                    && winding[beyond.index()] == UNKNOWN
                {
                    winding[beyond.index()] = winding[face.index()] - self.net(a, b);
                    open.push(beyond);
                }
            }
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
        for (corner, &at) in self.merged.iter().enumerate() {
            let [before, after] =
                [&self.previous, &self.next].map(|n| self.merged[n[corner] as usize] as usize);
            let here = FixedVertexHandle::from_index(at as usize);
            let mut edge = self
                .delaunay
                .vertex(here)
                .out_edges()
                .find(|edge| edge.to().index() == after)?;
            loop {
                let face = edge.face().as_inner()?;
                let k = (0..3).find(|&k| face.vertices()[k].fix() == here)?;
                let place = &mut corners[face.index()][k];
                if winding[face.index()] != 1 || *place != NONE {
                    return None;
                }
                *place = corner as u32;
                edge = edge.ccw();
                if edge.is_constraint_edge() {
                    break;
                }
            }
            if edge.to().index() != before {
                return None;
            }
        }
        Some(corners)
    }

    /// The faces of the piece by corners of the walks and added points.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        let winding = self.winding();
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

/// Different points and for each corner which of them it is.
fn merged_points<W: AsRef<[DVec2]>>(
    walks: &[W],
) -> Result<(Vec<Point2<f64>>, Vec<u32>), TriangulationError> {
    let mut numbers: HashMap<[u64; 2], u32> = HashMap::new();
    let mut points = Vec::new();
    let mut merged = Vec::new();
    for walk in walks {
        for p in walk.as_ref() {
            let [x, y] = [tame(p.x), tame(p.y)];
            let number = *numbers
                .entry([x.to_bits(), y.to_bits()])
                .or_insert_with(|| {
                    points.push(Point2::new(x, y));
                    points.len() as u32 - 1
                });
            merged.push(number);
        }
    }
    match walks.iter().map(|w| w.as_ref().len()).min() {
        Some(least) if least >= 3 => Ok((points, merged)),
        least => Err(TriangulationError::TooFewPoints(least.unwrap_or(0))),
    }
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

fn neighbours<W: AsRef<[DVec2]>>(walks: &[W]) -> (Vec<u32>, Vec<u32>) {
    let (mut next, mut previous) = (Vec::new(), Vec::new());
    for walk in walks {
        let (start, n) = (next.len() as u32, walk.as_ref().len() as u32);
        next.extend((0..n).map(|i| start + (i + 1) % n));
        previous.extend((0..n).map(|i| start + (i + n - 1) % n));
    }
    (next, previous)
}

/// Each edge once; refused are edges without length and edges that are
/// walked twice but not there and back.
fn net_edges(merged: &[u32], next: &[u32]) -> Result<HashMap<[u32; 2], i32>, TriangulationError> {
    let mut net: HashMap<[u32; 2], (i32, u32)> = HashMap::new();
    for (corner, &a) in merged.iter().enumerate() {
        let b = merged[next[corner] as usize];
        let entry = net.entry([a.min(b), a.max(b)]).or_default();
        entry.0 += if a < b { 1 } else { -1 };
        entry.1 += 1;
        if a == b || (entry.1 > 1 && entry.0 != 0) || entry.1 > 2 {
            return Err(TriangulationError::NotSimple);
        }
    }
    Ok(net
        .into_iter()
        .map(|(edge, (net, _))| (edge, net))
        .collect())
}
