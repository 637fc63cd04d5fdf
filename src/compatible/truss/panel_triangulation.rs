//! One polygon in two embeddings, cut into triangles.

use crate::geometry::{DVec2, SourceTarget, orient2d};
use crate::work::progress::{Cancelled, Progress, still_wanted};

/// No triangulation of a part of the polygon: less than any sine of its angles.
const NONE: f64 = -1.0;

/// Triangles between the nodes of a counter-clockwise cycle, all positive in
/// both designs, with the largest possible smallest angle; `None` if there
/// are none.
pub(super) fn triangulate_panel(
    cycle: &[u32],
    nodes: SourceTarget<&[DVec2]>,
    progress: &dyn Progress,
) -> Result<Option<Vec<[u32; 3]>>, Cancelled> {
    let table = ChordTable::filled(cycle, nodes, progress)?;
    let Some(last) = cycle.len().checked_sub(1) else {
        return Ok(None);
    };
    let mut faces = Vec::new();
    let mut open = vec![(0, last)];
    while let Some((i, j)) = open.pop() {
        if j - i < 2 {
            continue;
        }
        let (worth, k) = table.cells[table.cell(i, j)];
        if worth == NONE {
            return Ok(None);
        }
        faces.push([i, k, j].map(|corner| cycle[corner]));
        open.extend([(k, j), (i, k)]);
    }
    Ok(Some(faces))
}

/// For each chord i < j what the part from i to j is worth, and the third
/// corner of the triangle at the chord.
struct ChordTable {
    size: usize,
    cells: Vec<(f64, usize)>,
}

impl ChordTable {
    fn filled(
        cycle: &[u32],
        nodes: SourceTarget<&[DVec2]>,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let size = cycle.len();
        let mut table = Self {
            size,
            // The polygon's own edges have nothing behind them that could be bad.
            cells: vec![(f64::INFINITY, 0); size * size],
        };
        for length in 2..size {
            still_wanted(progress)?;
            for i in 0..size - length {
                let j = i + length;
                let cell = table.cell(i, j);
                table.cells[cell] = table.best(cycle, nodes, i, j);
            }
        }
        Ok(table)
    }

    fn cell(&self, i: usize, j: usize) -> usize {
        i * self.size + j
    }

    fn best(
        &self,
        cycle: &[u32],
        nodes: SourceTarget<&[DVec2]>,
        i: usize,
        j: usize,
    ) -> (f64, usize) {
        let mut best = (NONE, i);
        for k in i + 1..j {
            let sides = self.cells[self.cell(i, k)]
                .0
                .min(self.cells[self.cell(k, j)].0);
            // Before the exact signs, which are slow: no triangle mends a side.
            if sides <= best.0 {
                continue;
            }
            let corners = [i, k, j].map(|corner| cycle[corner] as usize);
            let here = worth(corners, nodes.source).min(worth(corners, nodes.target));
            if sides.min(here) > best.0 {
                best = (sides.min(here), k);
            }
        }
        best
    }
}

/// The sine of the smallest angle, [`NONE`] unless the triangle is positive.
fn worth(corners: [usize; 3], nodes: &[DVec2]) -> f64 {
    let [a, b, c] = corners.map(|corner| nodes[corner]);
    let twice_area = orient2d(a, b, c);
    if twice_area <= 0.0 {
        return NONE;
    }
    let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
    sides.sort_by(f64::total_cmp);
    // The smallest angle lies opposite the shortest side, between the others.
    let sine = twice_area / (sides[1] * sides[2]);
    // Lengths may underflow where the exact sign does not.
    if sine.is_finite() { sine } else { 0.0 }
}
