//! The guaranteed base for a piece with holes: cut along corresponding
//! bridges until one walk bounds it, triangulated as a disc, welded again.
//!
//! A bridge is a straight diagonal in one design. In the other it runs
//! through the triangulation from edge midpoint to edge midpoint, and the
//! diagonal gets as many points. Its points become movable vertices.

use super::boundary_rings::BoundaryRings;
use super::chords;
use super::error::PieceMeshError;
use super::overlay::overlay;
use super::pair_mesh::PairMesh;
use crate::compatible::assembly::MeshAssembly;
use crate::geometry::{DVec2, Side};
use crate::mesh::triangulation::constrained_delaunay;
use crate::mesh::{Connectivity, sides};
use crate::work::progress::{Progress, checkpoint};
use std::collections::{HashMap, VecDeque};

/// Diagonals tried for each bridge, shortest first. Each is a search through
/// the other design's triangulation; a better bridge only saves points that
/// are thinned out later.
const TRIED: usize = 12;

/// A corner of a walk in both designs and the vertex that it is.
#[derive(Clone, Copy)]
struct BridgeCorner {
    at: [DVec2; 2],
    vertex: u32,
}

/// Both designs' walks, which bound pieces that correspond.
struct PieceLoops(Vec<Vec<BridgeCorner>>);

/// A bridge between two corners, by their places in all walks, with its
/// inner points.
struct Bridge {
    ends: [usize; 2],
    inner: Vec<[DVec2; 2]>,
}

/// A mesh that is valid over the reals.
pub(super) fn bridged_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    let fixed = source.points.len();
    let mut walks = PieceLoops::of(source, target);
    let mut whole = MeshAssembly {
        points: [source.points.clone(), target.points.clone()],
        faces: Vec::new(),
    };
    // One hole at a time: the next bridge may start on this one's banks.
    let holes = walks.0.len();
    while walks.0.len() > 1 {
        let done = 1.0 - walks.0.len() as f64 / holes as f64;
        checkpoint(progress, "bridging", done)?;
        let bridge = walks.bridge()?;
        let first = whole.points[0].len() as u32;
        for &[p, q] in &bridge.inner {
            whole.points[0].push(p);
            whole.points[1].push(q);
        }
        walks.cut(&bridge, first);
    }
    let disc = &walks.0[0];
    let points = [0, 1].map(|d| disc.iter().map(|c| c.at[d]).collect::<Vec<_>>());
    let triangulations = chords::triangulations(&points[0], &points[1], progress)?;
    let mesh = overlay(&points[0], &points[1], &triangulations, progress)?;
    // Both banks of a bridge are one vertex again.
    let vertices: Vec<u32> = disc.iter().map(|corner| corner.vertex).collect();
    whole.add(
        &vertices,
        mesh.points.each_ref().map(Vec::as_slice),
        mesh.faces(),
    );
    Ok(PairMesh::new(fixed, whole.points, whole.faces))
}

impl PieceLoops {
    fn of(source: &BoundaryRings, target: &BoundaryRings) -> Self {
        let pairs = source.points.iter().zip(&target.points);
        let corner = |(vertex, (&p, &q))| BridgeCorner { at: [p, q], vertex };
        let mut corners = (0..).zip(pairs).map(corner);
        let walks = source.walks().into_iter();
        Self(
            walks
                .map(|walk| corners.by_ref().take(walk.len()).collect())
                .collect(),
        )
    }

    fn corners(&self) -> impl Iterator<Item = &BridgeCorner> {
        self.0.iter().flatten()
    }

    /// The bridge from the first walk to another one that needs the fewest
    /// inner points, and is straight in one design.
    fn bridge(&self) -> Result<Bridge, PieceMeshError> {
        let nets = [
            MidpointGraph::of(self, Side::Source)?,
            MidpointGraph::of(self, Side::Target)?,
        ];
        let ways = (0..2).flat_map(|straight| {
            let diagonals = self.diagonals(&nets[straight], straight).into_iter();
            let bent = &nets[1 - straight];
            diagonals.filter_map(move |ends| Some((straight, ends, bent.path(ends)?)))
        });
        // Of equal ones the first: straight in the source, and the shortest.
        let (straight, ends, bent) = ways
            .min_by_key(|(_, _, bent)| bent.len())
            .ok_or(PieceMeshError::NoBridge)?;
        let inner = self.along(ends, straight, &bent);
        Ok(Bridge { ends, inner })
    }

    /// The shortest diagonals from the first walk to the others.
    fn diagonals(&self, net: &MidpointGraph, design: usize) -> Vec<[usize; 2]> {
        let outer = self.0[0].len() as u32;
        let corners: Vec<&BridgeCorner> = self.corners().collect();
        let length = |&[a, b]: &[usize; 2]| {
            let [a, b] = [a, b].map(|k| corners[k].at[design]);
            a.distance_squared(b)
        };
        let mut found: Vec<[usize; 2]> = net
            .faces
            .iter()
            .flat_map(|&face| sides(face))
            // Once each: the other face beside it runs the edge the other way.
            .filter(|&[a, b]| a < outer && b >= outer)
            .map(|edge| edge.map(|k| k as usize))
            .collect();
        found.sort_by(|a, b| length(a).total_cmp(&length(b)).then(a.cmp(b)));
        found.truncate(TRIED);
        found
    }

    /// The inner points of a bridge, given those in the design where it is
    /// not straight.
    fn along(&self, ends: [usize; 2], straight: usize, inner: &[DVec2]) -> Vec<[DVec2; 2]> {
        let corners: Vec<&BridgeCorner> = self.corners().collect();
        let [a, b] = ends.map(|end| corners[end].at[straight]);
        let count = inner.len() as f64 + 1.0;
        let place = |(k, &bent): (usize, &DVec2)| {
            let even = a.lerp(b, (k + 1) as f64 / count);
            if straight == 0 {
                [even, bent]
            } else {
                [bent, even]
            }
        };
        inner.iter().enumerate().map(place).collect()
    }

    /// Joins a walk to the first one by both banks of a bridge.
    fn cut(&mut self, bridge: &Bridge, first: u32) {
        let [a, mut b] = bridge.ends;
        let mut w = 0;
        while b >= self.0[w].len() {
            b -= self.0[w].len();
            w += 1;
        }
        let hole = self.0.remove(w);
        let outer = std::mem::take(&mut self.0[0]);
        let there: Vec<BridgeCorner> = bridge
            .inner
            .iter()
            .zip(first..)
            .map(|(&at, vertex)| BridgeCorner { at, vertex })
            .collect();
        // Both walks all around, first corner to first corner, so that either
        // bank of the bridge has both its ends.
        let around = |walk: &[BridgeCorner], from: usize| {
            let n = walk.len();
            (0..=n).map(|k| walk[(from + k) % n]).collect::<Vec<_>>()
        };
        let back = there.iter().rev().copied();
        self.0[0] = around(&outer, a)
            .into_iter()
            .chain(there.iter().copied())
            .chain(around(&hole, b))
            .chain(back)
            .collect();
    }
}

/// A triangulation to find ways in: from corner to edge midpoint to edge
/// midpoint to corner.
struct MidpointGraph {
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
    points: Vec<DVec2>,
}

/// For each face that was reached the face and its side by which, if it is
/// not one of the first.
type PredecessorMap = HashMap<usize, Option<(usize, usize)>>;

impl MidpointGraph {
    fn of(walks: &PieceLoops, side: Side) -> Result<Self, PieceMeshError> {
        let points = |walk: &Vec<BridgeCorner>| walk.iter().map(|c| c.at[side]).collect::<Vec<_>>();
        let walks: Vec<Vec<DVec2>> = walks.0.iter().map(points).collect();
        let faces =
            constrained_delaunay(&walks).map_err(|error| PieceMeshError::Base { side, error })?;
        let connectivity = Connectivity::new(&faces)
            .unwrap_or_else(|_| unreachable!("faces of a triangulation meet edge to edge"));
        Ok(Self {
            faces,
            connectivity,
            points: walks.concat(),
        })
    }

    /// The fewest midpoints on a way between two corners, in order; none
    /// where an edge joins them.
    fn path(&self, ends: [usize; 2]) -> Option<Vec<DVec2>> {
        let [from, to] = ends.map(|end| end as u32);
        // All faces at the start before any other, so that one that has the
        // end too is found first.
        let mut open: VecDeque<usize> = (0..self.faces.len())
            .filter(|&f| self.faces[f].contains(&from))
            .collect();
        let mut reached: PredecessorMap = open.iter().map(|&f| (f, None)).collect();
        while let Some(f) = open.pop_front() {
            if self.faces[f].contains(&to) {
                return Some(self.way(f, &reached));
            }
            for k in 0..3 {
                if let Some(beyond) = self.connectivity.neighbour(f, k)
                    && !reached.contains_key(&beyond)
                {
                    reached.insert(beyond, Some((f, k)));
                    open.push_back(beyond);
                }
            }
        }
        None
    }

    fn way(&self, mut face: usize, reached: &PredecessorMap) -> Vec<DVec2> {
        let mut points = Vec::new();
        while let Some(&Some((before, k))) = reached.get(&face) {
            let [a, b] = sides(self.faces[before])[k].map(|v| self.points[v as usize]);
            // Halfway, the bridge is as far as can be from both ends: the parts
            // that it leaves have room.
            points.push(a.midpoint(b));
            face = before;
        }
        points.reverse();
        points
    }
}
