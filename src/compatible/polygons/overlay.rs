//! Base mesh of two simple polygons, which always exists in exact arithmetic: triangulations of
//! both polygons are drawn on one convex polygon and overlaid (Aronov, Seidel, Souvaine 1993).
//!
//! On a convex n-gon the vertex indices alone determine which chords of the two triangulations
//! cross, so crossings are found without coordinates. Every cell of the overlay (the common
//! refinement) is a convex polygon with three to six corners. In each design, each chord of the
//! design's own triangulation is straight, and the crossings on this chord are evenly spaced. This
//! makes every cell strictly convex in that design.
//!
//! Guaranteed in exact arithmetic: all faces are positive in both designs. Rounding can fold or
//! flatten faces where a polygon is about as thin as floating-point precision; the caller checks
//! every face exactly. There may be O(n²) crossings.

use super::chords::{diagonals, interleave};
use super::pair_mesh::PairMesh;
use crate::geometry::DVec2;
use crate::mesh::{sides, undirected};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::collections::HashMap;

/// Chord between two polygon vertices, given by their indices, the smaller first.
type Chord = [u32; 2];

/// Crossing of a chord of the source's triangulation with one of the target's.
struct ChordCrossing {
    /// Index of the mesh vertex at the crossing.
    vertex: u32,
    /// For each design: the rank of the crossing among all crossings on the chord of that design,
    /// counted from 1 at the chord's vertex with the smaller index.
    ranks: [u32; 2],
}

/// Returns the overlay (the common refinement) of the given triangulations of both polygons.
pub(super) fn overlay_triangulations(
    source: &[DVec2],
    target: &[DVec2],
    triangulations: &[Vec<[u32; 3]>; 2],
    progress: &dyn Progress,
) -> Result<PairMesh, Cancelled> {
    let n = source.len();
    let mut vertices = OverlayVertices {
        crossings: HashMap::new(),
        points: [source.to_vec(), target.to_vec()],
    };
    let chords = [0, 1].map(|d| diagonals(&triangulations[d], n));
    vertices.place_crossings(&chords, progress)?;
    let mut faces = Vec::new();
    // The intersection of a source triangle and a target triangle is a cell, a line segment, a
    // point or empty. The cells together fill the convex polygon.
    for &s in &triangulations[0] {
        check_cancelled(progress)?;
        for &t in &triangulations[1] {
            if let Some(cell) = vertices.cell(s, t) {
                vertices.fill(&cell, &mut faces);
            }
        }
    }
    Ok(PairMesh::new(n, vertices.points, faces))
}

/// Vertices of the overlay: polygon vertices and crossings.
struct OverlayVertices {
    /// Crossings, looked up by their two chords; the source's chord is first in the key.
    crossings: HashMap<[Chord; 2], ChordCrossing>,
    /// Vertex positions in source and target.
    points: [Vec<DVec2>; 2],
}

/// Returns a pair of chords with the source's chord first. `own` is the chord of `design`, `other`
/// the chord of the other design.
fn source_first(design: usize, own: Chord, other: Chord) -> [Chord; 2] {
    if design == 0 {
        [own, other]
    } else {
        [other, own]
    }
}

impl OverlayVertices {
    /// Adds a vertex for each crossing of a chord of the source's triangulation with a chord of the
    /// target's, and places it in both designs.
    fn place_crossings(
        &mut self,
        chords: &[Vec<Chord>; 2],
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        let n = self.points[0].len() as u32;
        for design in 0..2 {
            for &chord in &chords[design] {
                check_cancelled(progress)?;
                let crossed = crossing_chords(chord, &chords[1 - design], n);
                // The crossings divide the chord into equal sections, one more than there are
                // crossings.
                let count = crossed.len() as f64 + 1.0;
                let [a, b] = chord.map(|v| self.points[design][v as usize]);
                for (rank, other) in (1..).zip(crossed) {
                    let new = || {
                        let vertex = self.points[0].len() as u32;
                        self.points.iter_mut().for_each(|p| p.push(DVec2::ZERO));
                        ChordCrossing {
                            vertex,
                            ranks: [0; 2],
                        }
                    };
                    // A crossing is added when its source chord is visited. When its target chord
                    // is visited, the crossing is already present.
                    let chords = source_first(design, chord, other);
                    let crossing = self.crossings.entry(chords).or_insert_with(new);
                    crossing.ranks[design] = rank;
                    self.points[design][crossing.vertex as usize] =
                        a.lerp(b, f64::from(rank) / count);
                }
            }
        }
        Ok(())
    }

    /// Returns the corners of the intersection of a source triangle `s` and a target triangle `t`,
    /// counter-clockwise; `None` if the intersection has no area.
    fn cell(&self, s: [u32; 3], t: [u32; 3]) -> Option<Vec<u32>> {
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(6);
        for (design, own, other) in [(0, s, t), (1, t, s)] {
            for side in sides(own) {
                // A side that belongs to both triangles is found twice, once for each design. It is
                // added once.
                if let Some(edge) = self.clipped_side(design, side, other)
                    && !edges.contains(&edge)
                {
                    edges.push(edge);
                }
            }
        }
        if edges.len() < 3 {
            return None;
        }
        // Each edge of the cell is a directed part of a side. The edge that starts where the
        // previous one ends comes next, until the cycle is complete.
        let mut cycle = vec![edges[0].0];
        while cycle.len() < edges.len() {
            let last = cycle[cycle.len() - 1];
            cycle.push(edges.iter().find(|edge| edge.0 == last)?.1);
        }
        Some(cycle)
    }

    /// Returns the part of the side `side` that lies in the triangle `other` of the other design's
    /// triangulation, as two vertices in the direction of the side. `None` if that part of the side
    /// is a point or empty.
    fn clipped_side(&self, design: usize, side: [u32; 2], other: [u32; 3]) -> Option<(u32, u32)> {
        let chord = undirected(side);
        let mut ends: Vec<(u32, u32)> = Vec::with_capacity(2);
        // Rank of the chord's second end, larger than the rank of any crossing on the chord. The
        // first end has rank 0.
        let last = u32::MAX;
        for corner in side.iter().filter(|corner| other.contains(corner)) {
            ends.push((if *corner == chord[0] { 0 } else { last }, *corner));
        }
        for crossed in sides(other).map(undirected) {
            if interleave(chord, crossed) {
                let crossing = &self.crossings[&source_first(design, chord, crossed)];
                ends.push((crossing.ranks[design], crossing.vertex));
            }
        }
        ends.sort_unstable();
        // A chord meets the boundary of a triangle in two places, in one corner, or not at all.
        match ends[..] {
            [(_, low), (_, high)] if side == chord => Some((low, high)),
            [(_, low), (_, high)] => Some((high, low)),
            _ => None,
        }
    }

    /// Splits a cell into a fan of triangles around one of its corners. Of the fans around all
    /// corners, the one whose worst-shaped triangle has the best shape is used.
    fn fill(&self, cell: &[u32], faces: &mut Vec<[u32; 3]>) {
        let k = cell.len();
        let fan = |apex: usize| -> Vec<[u32; 3]> {
            (1..k - 1)
                .map(|i| [cell[apex], cell[(apex + i) % k], cell[(apex + i + 1) % k]])
                .collect()
        };
        // All fans of a triangular cell are the same, so one apex is enough. A cell is convex, so
        // the fan around any corner is valid.
        let apexes = if k == 3 { 1 } else { k };
        let worst_shape = |fan: &[[u32; 3]]| {
            let worst = |points: &Vec<DVec2>| {
                let shape = |f: &[u32; 3]| super::face_cost::shape(f.map(|v| points[v as usize]));
                fan.iter().map(shape).fold(1.0, f64::max)
            };
            worst(&self.points[0]).max(worst(&self.points[1]))
        };
        let best = (0..apexes)
            .map(fan)
            .min_by(|a, b| worst_shape(a).total_cmp(&worst_shape(b)));
        faces.extend(best.unwrap_or_default());
    }
}

/// Returns the chords of `others` that cross `chord`, in order from the end of `chord` with the
/// smaller index. `n` is the number of polygon vertices.
///
/// The chords of `others` do not cross each other, so the indices of their ends determine the
/// order.
fn crossing_chords([a, b]: Chord, others: &[Chord], n: u32) -> Vec<Chord> {
    let mut crossed: Vec<(u32, u32, Chord)> = others
        .iter()
        .filter(|&&other| interleave([a, b], other))
        .map(|&[c, d]| {
            let (near, far) = if a < c && c < b { (c, d) } else { (d, c) };
            // The chords are sorted by their end between a and b. Among chords that share this end,
            // the one whose other end is nearer to a comes first.
            (near, n - (far + n - b) % n, [c, d])
        })
        .collect();
    crossed.sort_unstable();
    crossed.into_iter().map(|(_, _, other)| other).collect()
}
