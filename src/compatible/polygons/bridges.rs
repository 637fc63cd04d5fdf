//! The guaranteed base for a piece with holes: cut along corresponding
//! bridges until one walk bounds it, triangulated as a disc, welded again.
//!
//! A bridge is a straight diagonal in one design. In the other it runs
//! through the triangulation from edge midpoint to edge midpoint, and the
//! diagonal gets as many points. Its points become movable vertices.

use super::chords;
use super::error::PolygonsError;
use super::overlay::overlay;
use super::pair::PairMesh;
use super::piece::Rings;
use crate::compatible::patchwork::Patchwork;
use crate::geometry::{DVec2, Side};
use crate::mesh::triangulation::constrained_delaunay;
use std::collections::{HashMap, VecDeque};

/// Diagonals tried for each bridge, shortest first.
const TRIED: usize = 12;

/// A corner of a walk in both designs and the vertex that it is.
#[derive(Clone, Copy)]
struct Corner {
    at: [DVec2; 2],
    vertex: u32,
}

/// Both designs' walks, which bound pieces that correspond.
struct Walks(Vec<Vec<Corner>>);

/// A bridge between two corners, by their places in all walks, with its
/// inner points.
struct Bridge {
    ends: [usize; 2],
    inner: Vec<[DVec2; 2]>,
}

/// A mesh that is valid over the reals.
pub(super) fn base(source: &Rings, target: &Rings) -> Result<PairMesh, PolygonsError> {
    let fixed = source.points.len();
    let mut walks = Walks::of(source, target);
    let mut whole = Patchwork {
        points: [source.points.clone(), target.points.clone()],
        faces: Vec::new(),
    };
    while walks.0.len() > 1 {
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
    let triangulations = chords::triangulations(&points[0], &points[1])?;
    let mesh = overlay(&points[0], &points[1], &triangulations);
    // Both banks of a bridge are one vertex again.
    let vertices: Vec<u32> = disc.iter().map(|corner| corner.vertex).collect();
    whole.add(
        &vertices,
        mesh.points.each_ref().map(Vec::as_slice),
        mesh.faces(),
    );
    Ok(PairMesh::new(fixed, whole.points, whole.faces))
}

impl Walks {
    fn of(source: &Rings, target: &Rings) -> Self {
        let mut vertex = 0;
        let mut corner = |(&p, &q): (&DVec2, &DVec2)| {
            vertex += 1;
            let at = [p, q];
            Corner {
                at,
                vertex: vertex - 1,
            }
        };
        let pairs = source.walks().into_iter().zip(target.walks());
        Self(
            pairs
                .map(|(p, q)| p.iter().zip(q).map(&mut corner).collect())
                .collect(),
        )
    }

    fn corners(&self) -> impl Iterator<Item = &Corner> {
        self.0.iter().flatten()
    }

    /// The corner of all that is corner `k` of a walk, and the walk.
    fn walk_of(&self, mut corner: usize) -> (usize, usize) {
        for (w, walk) in self.0.iter().enumerate() {
            if corner < walk.len() {
                return (w, corner);
            }
            corner -= walk.len();
        }
        (0, 0)
    }

    /// The bridge from the first walk to another one that needs the fewest
    /// inner points, and is straight in one design.
    fn bridge(&self) -> Result<Bridge, PolygonsError> {
        let nets = [Net::of(self, Side::Source)?, Net::of(self, Side::Target)?];
        let mut best: Option<Bridge> = None;
        for straight in 0..2 {
            for ends in self.diagonals(&nets[straight], straight) {
                let Some(inner) = nets[1 - straight].path(ends) else {
                    continue;
                };
                if best.as_ref().is_none_or(|b| inner.len() < b.inner.len()) {
                    let inner = self.along(ends, straight, &inner);
                    best = Some(Bridge { ends, inner });
                }
            }
        }
        best.ok_or(PolygonsError::NoBridge)
    }

    /// The shortest diagonals from the first walk to the others, as seen
    /// from the length of the walks' edges beside them.
    fn diagonals(&self, net: &Net, design: usize) -> Vec<[usize; 2]> {
        let outer = self.0[0].len() as u32;
        let corners: Vec<&Corner> = self.corners().collect();
        let length = |&[a, b]: &[usize; 2]| {
            let [a, b] = [a, b].map(|k| corners[k].at[design]);
            a.distance_squared(b)
        };
        let mut found: Vec<[usize; 2]> = net
            .faces
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
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
        let [a, b] = ends.map(|end| {
            let (w, k) = self.walk_of(end);
            self.0[w][k].at[straight]
        });
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
        let [(_, a), (w, b)] = bridge.ends.map(|end| self.walk_of(end));
        let hole = self.0.remove(w);
        let outer = std::mem::take(&mut self.0[0]);
        let there: Vec<Corner> = bridge
            .inner
            .iter()
            .zip(first..)
            .map(|(&at, vertex)| Corner { at, vertex })
            .collect();
        let around = |walk: &[Corner], from: usize| {
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
struct Net {
    faces: Vec<[u32; 3]>,
    /// For each directed edge the face to its left.
    left: HashMap<[u32; 2], u32>,
    points: Vec<DVec2>,
}

impl Net {
    fn of(walks: &Walks, side: Side) -> Result<Self, PolygonsError> {
        let points = |walk: &Vec<Corner>| walk.iter().map(|c| c.at[side]).collect::<Vec<_>>();
        let walks: Vec<Vec<DVec2>> = walks.0.iter().map(points).collect();
        let faces =
            constrained_delaunay(&walks).map_err(|error| PolygonsError::Base { side, error })?;
        let mut left = HashMap::new();
        for (f, &[a, b, c]) in faces.iter().enumerate() {
            left.extend([[a, b], [b, c], [c, a]].map(|edge| (edge, f as u32)));
        }
        Ok(Self {
            faces,
            left,
            points: walks.concat(),
        })
    }

    /// The fewest midpoints on a way between two corners, in order.
    fn path(&self, [from, to]: [usize; 2]) -> Option<Vec<DVec2>> {
        let [from, to] = [from as u32, to as u32];
        if self.left.contains_key(&[from, to]) || self.left.contains_key(&[to, from]) {
            return Some(Vec::new());
        }
        // The way to a face is through the edge by which it was entered.
        let mut entered: HashMap<u32, Option<[u32; 2]>> = HashMap::new();
        let mut open = VecDeque::new();
        for (f, face) in self.faces.iter().enumerate() {
            if face.contains(&from) {
                entered.insert(f as u32, None);
                open.push_back(f as u32);
            }
        }
        while let Some(f) = open.pop_front() {
            let face = self.faces[f as usize];
            if face.contains(&to) {
                return Some(self.way(f, &entered));
            }
            for [a, b] in [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]] {
                // The way crosses the edge from its left to its right.
                if let Some(&beyond) = self.left.get(&[b, a])
                    && !entered.contains_key(&beyond)
                {
                    entered.insert(beyond, Some([a, b]));
                    open.push_back(beyond);
                }
            }
        }
        None
    }

    fn way(&self, mut face: u32, entered: &HashMap<u32, Option<[u32; 2]>>) -> Vec<DVec2> {
        let mut points = Vec::new();
        while let Some(&Some(edge)) = entered.get(&face) {
            let [a, b] = edge.map(|v| self.points[v as usize]);
            points.push(a.midpoint(b));
            match self.left.get(&edge) {
                Some(&before) => face = before,
                None => break,
            }
        }
        points.reverse();
        points
    }
}
