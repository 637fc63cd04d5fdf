//! Triangulates one polygon in several embeddings at once so that the smallest angle over all is as
//! large as possible.

use crate::geometry::{DVec2, orient2d};
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Marks a part of the polygon that has no triangulation; smaller than the sine of any angle of a
/// triangle.
const NO_TRIANGULATION: f64 = -1.0;

/// Triangulates the polygon with the given nodes in counter-clockwise order. All triangles are
/// positive in all `embeddings`, lists of the nodes' positions, and the smallest angle over all is
/// as large as possible. `None` if there is no such triangulation.
pub(in crate::compatible) fn triangulate_panel(
    cycle: &[u32],
    embeddings: &[&[DVec2]],
    progress: &dyn Progress,
) -> Result<Option<Vec<[u32; 3]>>, Cancelled> {
    let table = ChordTable::fill(cycle, embeddings, progress)?;
    let Some(last) = cycle.len().checked_sub(1) else {
        return Ok(None);
    };
    let mut faces = Vec::new();
    let mut pending = vec![(0, last)];
    while let Some((i, j)) = pending.pop() {
        if j - i < 2 {
            continue;
        }
        let (sine, k) = table.cells[table.cell(i, j)];
        if sine == NO_TRIANGULATION {
            return Ok(None);
        }
        faces.push([i, k, j].map(|corner| cycle[corner]));
        pending.extend([(k, j), (i, k)]);
    }
    Ok(Some(faces))
}

/// Table of the dynamic program. The chord i–j, i < j, cuts off the part of the polygon with the
/// corners i to j. The cell of the chord contains the sine of the smallest angle in the best
/// triangulation of that part, and the third corner of the triangle at the chord.
struct ChordTable {
    size: usize,
    cells: Vec<(f64, usize)>,
}

impl ChordTable {
    /// Fills the table, from chords that skip few corners to chords that skip many.
    fn fill(
        cycle: &[u32],
        embeddings: &[&[DVec2]],
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let size = cycle.len();
        let mut table = Self {
            size,
            // The polygon's own edges cut off nothing, so they do not limit the smallest angle.
            cells: vec![(f64::INFINITY, 0); size * size],
        };
        for length in 2..size {
            check_cancelled(progress)?;
            for i in 0..size - length {
                let j = i + length;
                let cell = table.cell(i, j);
                table.cells[cell] = table.best_corner(cycle, embeddings, i, j);
            }
        }
        Ok(table)
    }

    /// Index of the cell of the chord i–j.
    fn cell(&self, i: usize, j: usize) -> usize {
        i * self.size + j
    }

    /// Returns the cell of the chord i–j, for the best triangulation of the part that the chord
    /// cuts off: the sine of its smallest angle, and the third corner of its triangle at the chord.
    fn best_corner(
        &self,
        cycle: &[u32],
        embeddings: &[&[DVec2]],
        i: usize,
        j: usize,
    ) -> (f64, usize) {
        let mut best = (NO_TRIANGULATION, i);
        for k in i + 1..j {
            let parts = self.cells[self.cell(i, k)]
                .0
                .min(self.cells[self.cell(k, j)].0);
            // The smallest angle cannot exceed that of the two parts of the polygon next to the
            // triangle. If it cannot exceed the best one so far, the slow exact predicates are
            // skipped.
            if parts <= best.0 {
                continue;
            }
            let corners = [i, k, j].map(|corner| cycle[corner] as usize);
            let sines = embeddings.iter().map(|nodes| smallest_sine(corners, nodes));
            let own = sines.fold(f64::INFINITY, f64::min);
            if parts.min(own) > best.0 {
                best = (parts.min(own), k);
            }
        }
        best
    }
}

/// Returns the sine of a triangle's smallest angle; [`NO_TRIANGULATION`] if the triangle is not
/// positive.
fn smallest_sine(corners: [usize; 3], nodes: &[DVec2]) -> f64 {
    let [a, b, c] = corners.map(|corner| nodes[corner]);
    let twice_area = orient2d(a, b, c);
    if twice_area <= 0.0 {
        return NO_TRIANGULATION;
    }
    let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
    sides.sort_by(f64::total_cmp);
    // The smallest angle lies opposite the shortest side and between the two longer ones.
    let sine = twice_area / (sides[1] * sides[2]);
    // The product of lengths may underflow to 0 although the exact sign is positive.
    if sine.is_finite() { sine } else { 0.0 }
}
