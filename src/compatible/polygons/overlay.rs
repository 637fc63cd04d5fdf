//! The guaranteed base: both polygons' triangulations drawn on one convex
//! polygon (Aronov, Seidel, Souvaine 1993).
//!
//! On a convex n-gon the chords of the two triangulations cross in a pattern
//! that the vertex numbers alone decide, so nothing is computed with
//! coordinates. Every common refinement cell is a convex polygon of three to
//! six corners. In each design the crossings on one of its chords stand at
//! even distances along it, which keeps every cell strictly convex there.
//!
//! Guaranteed over the reals: all faces positive in both designs. Rounding
//! can spoil it where a polygon is as thin as its last digits; the caller
//! checks every face exactly. There may be O(n²) crossings.

use super::chords::{diagonals, interleave};
use super::pair_mesh::PairMesh;
use crate::geometry::DVec2;
use crate::mesh::{sides, undirected};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use std::collections::HashMap;

type Chord = [u32; 2];

/// Where a chord of the source's triangulation crosses one of the target's.
struct ChordCrossing {
    vertex: u32,
    /// Which of the crossings on its chord it is in either design, counted
    /// from 1 at the chord's smaller end.
    ranks: [u32; 2],
}

/// The common refinement of the triangulations of both polygons.
pub(super) fn overlay(
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
    // Two triangles of a convex polygon share a cell, a side, a corner or
    // nothing, and all cells together are the polygon.
    for &s in &triangulations[0] {
        still_wanted(progress)?;
        for &t in &triangulations[1] {
            if let Some(cell) = vertices.cell(s, t) {
                vertices.fill(&cell, &mut faces);
            }
        }
    }
    Ok(PairMesh::new(n, vertices.points, faces))
}

/// The corners of all cells: the polygons' vertices and the crossings.
struct OverlayVertices {
    /// By the chords of either design.
    crossings: HashMap<[Chord; 2], ChordCrossing>,
    points: [Vec<DVec2>; 2],
}

/// A chord of one design and one of the other, the source's first.
fn in_order(design: usize, own: Chord, other: Chord) -> [Chord; 2] {
    if design == 0 {
        [own, other]
    } else {
        [other, own]
    }
}

impl OverlayVertices {
    /// Numbers all crossings and places them in both designs.
    fn place_crossings(
        &mut self,
        chords: &[Vec<Chord>; 2],
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        let n = self.points[0].len() as u32;
        for design in 0..2 {
            for &chord in &chords[design] {
                still_wanted(progress)?;
                let crossed = along(chord, &chords[1 - design], n);
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
                    // New from the source's chord, there already from the target's.
                    let chords = in_order(design, chord, other);
                    let crossing = self.crossings.entry(chords).or_insert_with(new);
                    crossing.ranks[design] = rank;
                    self.points[design][crossing.vertex as usize] =
                        a.lerp(b, f64::from(rank) / count);
                }
            }
        }
        Ok(())
    }

    /// The corners of the common part of two triangles, counter-clockwise.
    fn cell(&self, s: [u32; 3], t: [u32; 3]) -> Option<Vec<u32>> {
        let mut next: Vec<(u32, u32)> = Vec::with_capacity(6);
        for (design, own, other) in [(0, s, t), (1, t, s)] {
            for side in sides(own) {
                // A side of both triangles comes twice.
                if let Some(edge) = self.piece(design, side, other)
                    && !next.contains(&edge)
                {
                    next.push(edge);
                }
            }
        }
        if next.len() < 3 {
            return None;
        }
        let mut cycle = vec![next[0].0];
        while cycle.len() < next.len() {
            let last = cycle[cycle.len() - 1];
            cycle.push(next.iter().find(|edge| edge.0 == last)?.1);
        }
        Some(cycle)
    }

    /// The piece of a side, directed like it, that lies in the other
    /// triangulation's triangle `other`; none if it is a point or nothing.
    fn piece(&self, design: usize, side: [u32; 2], other: [u32; 3]) -> Option<(u32, u32)> {
        let chord = undirected(side);
        let mut found: Vec<(u32, u32)> = Vec::with_capacity(2);
        // Beyond every crossing's rank.
        let last = u32::MAX;
        for end in side.iter().filter(|end| other.contains(end)) {
            found.push((if *end == chord[0] { 0 } else { last }, *end));
        }
        for crossed in sides(other).map(undirected) {
            if interleave(chord, crossed) {
                let crossing = &self.crossings[&in_order(design, chord, crossed)];
                found.push((crossing.ranks[design], crossing.vertex));
            }
        }
        found.sort_unstable();
        // A line meets a triangle in two places at most, or in one corner.
        match found[..] {
            [(_, low), (_, high)] if side == chord => Some((low, high)),
            [(_, low), (_, high)] => Some((high, low)),
            _ => None,
        }
    }

    /// Cuts a cell into the fan whose worst triangle is best.
    fn fill(&self, cell: &[u32], faces: &mut Vec<[u32; 3]>) {
        let k = cell.len();
        let fan = |apex: usize| -> Vec<[u32; 3]> {
            (1..k - 1)
                .map(|i| [cell[apex], cell[(apex + i) % k], cell[(apex + i + 1) % k]])
                .collect()
        };
        // All fans of a triangle are one; any fan of a convex cell is valid.
        let apexes = if k == 3 { 1 } else { k };
        let worth = |fan: &[[u32; 3]]| {
            let worst = |points: &Vec<DVec2>| {
                let shape = |f: &[u32; 3]| super::face_cost::shape(f.map(|v| points[v as usize]));
                fan.iter().map(shape).fold(1.0, f64::max)
            };
            worst(&self.points[0]).max(worst(&self.points[1]))
        };
        let best = (0..apexes)
            .map(fan)
            .min_by(|a, b| worth(a).total_cmp(&worth(b)));
        faces.extend(best.unwrap_or_default());
    }
}

/// The chords of `others` that cross `chord`, in order from its smaller end.
///
/// They do not cross each other, so that their ends on either side decide.
fn along([a, b]: Chord, others: &[Chord], n: u32) -> Vec<Chord> {
    let mut crossed: Vec<(u32, u32, Chord)> = others
        .iter()
        .filter(|&&other| interleave([a, b], other))
        .map(|&[c, d]| {
            let (near, far) = if a < c && c < b { (c, d) } else { (d, c) };
            // By the end between a and b; of those that share it, one crosses
            // nearer to a whose other end is nearer to it.
            (near, n - (far + n - b) % n, [c, d])
        })
        .collect();
    crossed.sort_unstable();
    crossed.into_iter().map(|(_, _, other)| other).collect()
}
