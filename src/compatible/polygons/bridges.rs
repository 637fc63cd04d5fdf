//! Base mesh of a piece with holes: a triangulation in both designs that always exists in exact
//! arithmetic. The piece is cut open along corresponding bridges until it is a disc. The disc is
//! triangulated, and the mesh is welded along the bridges.
//!
//! A bridge joins the outer boundary to a hole. In one design it is a straight diagonal. In the
//! other design it runs through a triangulation of the piece, from edge midpoint to edge midpoint;
//! these midpoints are the inner points of the bridge. The straight diagonal gets the same number
//! of inner points. Inner points become movable vertices of the mesh.

use super::boundary_rings::BoundaryRings;
use super::chords;
use super::error::PieceMeshError;
use super::overlay::overlay_triangulations;
use super::pair_mesh::PairMesh;
use crate::compatible::assembly::MeshAssembly;
use crate::geometry::{DVec2, Side};
use crate::mesh::triangulation::constrained_delaunay;
use crate::mesh::{Connectivity, sides};
use crate::work::progress::{Progress, checkpoint};
use std::collections::{HashMap, VecDeque};

/// Maximum number of diagonals tried for each bridge in each design, shortest first (resource
/// limit: each diagonal needs a search through the other design's triangulation. More diagonals
/// could only save inner points, most of which are removed later anyway).
const MAX_DIAGONALS: usize = 12;

/// Corner of a boundary loop, with its positions in both designs and its vertex index.
#[derive(Clone, Copy)]
struct BridgeCorner {
    places: [DVec2; 2],
    vertex: u32,
}

/// Boundary loops of a piece in both designs: the outer one first, then the holes that no bridge
/// has reached yet.
struct PieceLoops(Vec<Vec<BridgeCorner>>);

/// Bridge between the two corners with the numbers `ends`. Corners are numbered consecutively
/// through all loops. `inner` contains the positions of the bridge's inner points in both designs.
struct Bridge {
    ends: [usize; 2],
    inner: Vec<[DVec2; 2]>,
}

/// Returns the base mesh of a piece. It is valid in exact arithmetic; rounding may flatten faces,
/// which the caller checks.
pub(super) fn bridged_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    let fixed = source.points.len();
    let mut loops = PieceLoops::of(source, target);
    let mut whole = MeshAssembly {
        points: [source.points.clone(), target.points.clone()],
        faces: Vec::new(),
    };
    // Only one hole is joined at a time, so that the next bridge may start on the hole joined last.
    let holes = loops.0.len();
    while loops.0.len() > 1 {
        let done = 1.0 - loops.0.len() as f64 / holes as f64;
        checkpoint(progress, "bridging", done)?;
        let bridge = loops.bridge()?;
        let first = whole.points[0].len() as u32;
        for &[p, q] in &bridge.inner {
            whole.points[0].push(p);
            whole.points[1].push(q);
        }
        loops.merge(&bridge, first);
    }
    // The single remaining loop bounds a disc.
    let disc = &loops.0[0];
    let points = [0, 1].map(|d| disc.iter().map(|c| c.places[d]).collect::<Vec<_>>());
    let triangulations = chords::triangulations(&points[0], &points[1], progress)?;
    let mesh = overlay_triangulations(&points[0], &points[1], &triangulations, progress)?;
    // The corners on both banks of a bridge have the same vertex indices. Appending the disc's mesh
    // by these indices therefore closes the cuts along the bridges.
    let vertices: Vec<u32> = disc.iter().map(|corner| corner.vertex).collect();
    whole.append(
        &vertices,
        mesh.points.each_ref().map(Vec::as_slice),
        mesh.faces(),
    );
    Ok(PairMesh::new(fixed, whole.points, whole.faces))
}

impl PieceLoops {
    /// Pairs the loops of both designs. Vertices are numbered ring after ring.
    fn of(source: &BoundaryRings, target: &BoundaryRings) -> Self {
        let pairs = source.points.iter().zip(&target.points);
        let corner = |(vertex, (&p, &q))| BridgeCorner {
            places: [p, q],
            vertex,
        };
        let mut corners = (0..).zip(pairs).map(corner);
        let loops = source.loops().into_iter();
        Self(
            loops
                .map(|ring| corners.by_ref().take(ring.len()).collect())
                .collect(),
        )
    }

    /// Returns the corners of all loops, loop after loop. This is the order in which they are
    /// numbered.
    fn corners(&self) -> impl Iterator<Item = &BridgeCorner> {
        self.0.iter().flatten()
    }

    /// Returns the bridge with the fewest inner points (points between its ends) from the first
    /// loop to any other loop.
    fn bridge(&self) -> Result<Bridge, PieceMeshError> {
        let graphs = [
            MidpointGraph::of(self, Side::Source)?,
            MidpointGraph::of(self, Side::Target)?,
        ];
        let candidates = (0..2).flat_map(|straight| {
            let diagonals = self.diagonals(&graphs[straight], straight).into_iter();
            let bent = &graphs[1 - straight];
            diagonals.filter_map(move |ends| Some((straight, ends, bent.path(ends)?)))
        });
        // Of bridges with equally few inner points the first is chosen. Bridges that are straight
        // in the source come first, and shorter ones before longer ones.
        let (straight, ends, bent) = candidates
            .min_by_key(|(_, _, bent)| bent.len())
            .ok_or(PieceMeshError::NoBridge)?;
        let inner = self.inner_points(ends, straight, &bent);
        Ok(Bridge { ends, inner })
    }

    /// Returns diagonals of a design's triangulation that lead from the first loop to another loop,
    /// each as the numbers of its two corners. They are sorted, shortest first; at most
    /// [`MAX_DIAGONALS`] are returned.
    fn diagonals(&self, graph: &MidpointGraph, design: usize) -> Vec<[usize; 2]> {
        // Number of corners of the first loop. The corners numbered from 0 to `outer` − 1 belong to
        // it.
        let outer = self.0[0].len() as u32;
        let corners: Vec<&BridgeCorner> = self.corners().collect();
        let length = |&[a, b]: &[usize; 2]| {
            let [a, b] = [a, b].map(|k| corners[k].places[design]);
            a.distance_squared(b)
        };
        let mut shortest: Vec<[usize; 2]> = graph
            .faces
            .iter()
            .flat_map(|&face| sides(face))
            // Each diagonal passes this filter once: the face on its other side lists it in the
            // opposite direction, which does not pass.
            .filter(|&[a, b]| a < outer && b >= outer)
            .map(|edge| edge.map(|k| k as usize))
            .collect();
        shortest.sort_by(|a, b| length(a).total_cmp(&length(b)).then(a.cmp(b)));
        shortest.truncate(MAX_DIAGONALS);
        shortest
    }

    /// Returns the inner points of a bridge in both designs. `inner` contains their positions in
    /// the design where the bridge is bent; in the design `straight` they are spaced evenly.
    fn inner_points(&self, ends: [usize; 2], straight: usize, inner: &[DVec2]) -> Vec<[DVec2; 2]> {
        let corners: Vec<&BridgeCorner> = self.corners().collect();
        let [a, b] = ends.map(|end| corners[end].places[straight]);
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

    /// Merges the loop at the second end of a bridge into the first loop. The merged loop passes
    /// both banks of the bridge. `first_vertex` is the vertex index of the bridge's first inner
    /// point.
    fn merge(&mut self, bridge: &Bridge, first_vertex: u32) {
        let [a, mut b] = bridge.ends;
        // Corners are numbered through all loops, so the loop that contains corner `b` is searched
        // for.
        let mut loop_index = 0;
        while b >= self.0[loop_index].len() {
            b -= self.0[loop_index].len();
            loop_index += 1;
        }
        let hole = self.0.remove(loop_index);
        let outer = std::mem::take(&mut self.0[0]);
        let bridge_corners: Vec<BridgeCorner> = bridge
            .inner
            .iter()
            .zip(first_vertex..)
            .map(|(&places, vertex)| BridgeCorner { places, vertex })
            .collect();
        // Each loop runs all the way round and repeats its first corner, so that both banks of the
        // bridge have both end points.
        let around = |ring: &[BridgeCorner], from: usize| {
            let n = ring.len();
            (0..=n).map(|k| ring[(from + k) % n]).collect::<Vec<_>>()
        };
        let back = bridge_corners.iter().rev().copied();
        self.0[0] = around(&outer, a)
            .into_iter()
            .chain(bridge_corners.iter().copied())
            .chain(around(&hole, b))
            .chain(back)
            .collect();
    }
}

/// Triangulation of the loops in one design. It is searched for paths that lead from a corner over
/// edge midpoints to another corner.
struct MidpointGraph {
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
    points: Vec<DVec2>,
}

/// For each face that the search has reached: the face from which it was reached, and the index of
/// the side that lies between the two in that earlier face. `None` for the faces at the start
/// corner.
type PredecessorMap = HashMap<usize, Option<(usize, usize)>>;

impl MidpointGraph {
    /// Triangulates the loops in one design.
    fn of(piece_loops: &PieceLoops, side: Side) -> Result<Self, PieceMeshError> {
        let points =
            |ring: &Vec<BridgeCorner>| ring.iter().map(|c| c.places[side]).collect::<Vec<_>>();
        let loops: Vec<Vec<DVec2>> = piece_loops.0.iter().map(points).collect();
        let faces =
            constrained_delaunay(&loops).map_err(|error| PieceMeshError::Base { side, error })?;
        let connectivity = Connectivity::new(&faces)
            .unwrap_or_else(|_| unreachable!("faces of a triangulation meet edge to edge"));
        Ok(Self {
            faces,
            connectivity,
            points: loops.concat(),
        })
    }

    /// Finds the path between two corners that crosses the fewest edges, and returns the midpoints
    /// of these edges in order. The list is empty if the corners share a face. `None` if no path
    /// exists.
    fn path(&self, ends: [usize; 2]) -> Option<Vec<DVec2>> {
        let [from, to] = ends.map(|end| end as u32);
        // All faces at the start corner are queued first. If one of them also contains the end
        // corner, it is found before any longer path.
        let mut open: VecDeque<usize> = (0..self.faces.len())
            .filter(|&f| self.faces[f].contains(&from))
            .collect();
        let mut reached: PredecessorMap = open.iter().map(|&f| (f, None)).collect();
        // The search is breadth first, so the first path found crosses the fewest edges.
        while let Some(f) = open.pop_front() {
            if self.faces[f].contains(&to) {
                return Some(self.midpoints_to(f, &reached));
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

    /// Returns the midpoints of the edges that are crossed before `face` is reached, in order.
    fn midpoints_to(&self, mut face: usize, reached: &PredecessorMap) -> Vec<DVec2> {
        let mut points = Vec::new();
        while let Some(&Some((before, k))) = reached.get(&face) {
            let [a, b] = sides(self.faces[before])[k].map(|v| self.points[v as usize]);
            // The midpoint is as far as possible from both ends of the edge, which leaves room on
            // both sides.
            points.push(a.midpoint(b));
            face = before;
        }
        points.reverse();
        points
    }
}
