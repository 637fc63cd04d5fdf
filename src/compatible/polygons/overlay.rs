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
use super::pair::PairMesh;
use crate::geometry::DVec2;
use std::collections::HashMap;

type Chord = [u32; 2];

/// A corner of a cell: a polygon vertex or the crossing of a chord of the
/// source's triangulation with one of the target's.
type Names = HashMap<(Chord, Chord), u32>;

/// The common refinement of the triangulations of both polygons.
pub(super) fn overlay(
    source: &[DVec2],
    target: &[DVec2],
    [of_source, of_target]: &[Vec<[u32; 3]>; 2],
) -> PairMesh {
    let n = source.len();
    let chords = [diagonals(of_source, n), diagonals(of_target, n)];
    let mut vertices = Vertices {
        names: Names::new(),
        places: [HashMap::new(), HashMap::new()],
        points: [source.to_vec(), target.to_vec()],
    };
    vertices.place_crossings(&chords);
    let mut faces = Vec::new();
    for &s in of_source {
        for &t in of_target {
            if let Some(cell) = vertices.cell(s, t) {
                vertices.fill(&cell, &mut faces);
            }
        }
    }
    let [source, target] = vertices.points;
    PairMesh::new(n, source, target, faces)
}

struct Vertices {
    names: Names,
    /// For each chord of either triangulation, where along it, from its
    /// smaller end, each crossing stands.
    places: [HashMap<(Chord, u32), u32>; 2],
    points: [Vec<DVec2>; 2],
}

impl Vertices {
    /// Numbers all crossings and places them in both designs.
    fn place_crossings(&mut self, chords: &[Vec<Chord>; 2]) {
        let n = self.points[0].len() as u32;
        let mut on_source = Vec::new();
        for &s in &chords[0] {
            for crossed in along(s, &chords[1], n) {
                let vertex = n + on_source.len() as u32;
                self.names.insert((s, crossed), vertex);
                on_source.push((s, crossed));
            }
        }
        let placed = DVec2::ZERO;
        self.points
            .iter_mut()
            .for_each(|points| points.resize(n as usize + on_source.len(), placed));
        for &s in &chords[0] {
            let crossings = along(s, &chords[1], n).into_iter().map(|t| (s, t));
            self.place(0, s, crossings.collect());
        }
        for &t in &chords[1] {
            let crossings = along(t, &chords[0], n).into_iter().map(|s| (s, t));
            self.place(1, t, crossings.collect());
        }
    }

    fn place(&mut self, design: usize, chord: Chord, crossings: Vec<(Chord, Chord)>) {
        let count = crossings.len() as f64 + 1.0;
        let [a, b] = chord.map(|v| self.points[design][v as usize]);
        for (rank, crossing) in crossings.into_iter().enumerate() {
            let vertex = self.names[&crossing];
            let share = (rank + 1) as f64 / count;
            self.points[design][vertex as usize] = a.lerp(b, share);
            self.places[design].insert((chord, vertex), rank as u32 + 1);
        }
    }

    /// The corners of the common part of two triangles, counter-clockwise.
    fn cell(&self, s: [u32; 3], t: [u32; 3]) -> Option<Vec<u32>> {
        let mut next: Vec<(u32, u32)> = Vec::with_capacity(6);
        let sides = |f: [u32; 3]| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]];
        for (design, own, other) in [(0, s, t), (1, t, s)] {
            for side in sides(own) {
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
        let chord = [side[0].min(side[1]), side[0].max(side[1])];
        let mut found: Vec<(u32, u32)> = Vec::with_capacity(2);
        let last = u32::MAX;
        for end in side.iter().filter(|end| other.contains(end)) {
            found.push((if *end == chord[0] { 0 } else { last }, *end));
        }
        for [c, d] in [
            [other[0], other[1]],
            [other[1], other[2]],
            [other[2], other[0]],
        ] {
            let crossed = [c.min(d), c.max(d)];
            if interleave(chord, crossed) {
                let key = if design == 0 {
                    (chord, crossed)
                } else {
                    (crossed, chord)
                };
                let vertex = self.names[&key];
                found.push((self.places[design][&(chord, vertex)], vertex));
            }
        }
        found.sort_unstable();
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
        let apexes = if k == 3 { 1 } else { k };
        let worth = |fan: &[[u32; 3]]| {
            let worst = |points: &Vec<DVec2>| {
                let shape = |f: &[u32; 3]| super::face::shape(f.map(|v| points[v as usize]));
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
            (near, n - (far + n - b) % n, [c, d])
        })
        .collect();
    crossed.sort_unstable();
    crossed.into_iter().map(|(_, _, other)| other).collect()
}
