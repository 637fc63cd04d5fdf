//! Signed chamfer distance transforms: city-block, chessboard and quasi-Euclidean metrics.
//!
//! Makes two passes over the cells. Each pass looks at four of the eight neighbours of a cell
//! (Rosenfeld and Pfaltz 1966, Montanari 1968, Borgefors 1986). The steps of a shortest path can be
//! reordered so that the two passes follow it, so results are exact in these metrics up to the
//! rounding of √2. The same two passes compute the distances of inside and of outside cells,
//! because an outside neighbour of an inside cell counts as distance 0, and vice versa.

use super::Mask;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use std::ops::Range;

/// Number of rows between two progress reports, which also check for cancellation (resource limit).
const REPORT_ROWS: usize = 64;

/// Computes the signed distances of all cells of `mask` in row-major order. A step along an axis
/// has length 1, a diagonal step has length `diagonal`.
pub(super) fn distances(
    mask: &Mask,
    diagonal: f64,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Cancelled> {
    let height = mask.height() as usize;
    let mut lengths = ChamferDistances::of(mask);
    let report = |done: usize| {
        let fraction = 0.5 * done as f64 / height as f64;
        checkpoint(progress, "measuring distances", fraction)
    };
    for y in 0..height {
        if y % REPORT_ROWS == 0 {
            report(y)?;
        }
        let row = lengths.row(y);
        // Before cell `i`, this pass has visited its left neighbour and the three neighbours below.
        row.for_each(|i| lengths.visit(i, diagonal, |i, step| i - step));
    }
    for y in (0..height).rev() {
        if y % REPORT_ROWS == 0 {
            report(2 * height - 1 - y)?;
        }
        let row = lengths.row(y).rev();
        row.for_each(|i| lengths.visit(i, diagonal, |i, step| i + step));
    }
    let cells = (0..height).flat_map(|y| lengths.row(y));
    Ok(cells.map(|i| lengths.signed_distance(i)).collect())
}

/// Working data of the two passes: for each cell of a mask, and for a border of outside cells
/// around the mask, whether the cell is inside, and its unsigned distance. Cells are in row-major
/// order.
struct ChamferDistances {
    /// Whether each cell is inside.
    sides: Vec<bool>,
    /// Distance from the centre of each cell to the centre of the nearest cell on the other side of
    /// the boundary. It is an upper bound until both passes are done.
    lengths: Vec<f64>,
    /// Number of cells in a row, including the border of one outside cell at each end.
    stride: usize,
}

impl ChamferDistances {
    /// Copies from `mask` which cells are inside, and sets all distances to infinity.
    fn of(mask: &Mask) -> Self {
        let (width, height) = (mask.width() as usize, mask.height() as usize);
        // The border of outside cells makes checks for the edge of the mask unnecessary.
        let stride = width + 2;
        let cells = stride * (height + 2);
        let mut distances = Self {
            sides: vec![false; cells],
            lengths: vec![f64::INFINITY; cells],
            stride,
        };
        for (y, bits) in mask.bits().chunks_exact(width).enumerate() {
            let row = distances.row(y);
            distances.sides[row].copy_from_slice(bits);
        }
        distances
    }

    /// Indices of the cells in row `y` of the mask, without the border of outside cells.
    fn row(&self, y: usize) -> Range<usize> {
        let first = (y + 1) * self.stride + 1;
        first..first + self.stride - 2
    }

    /// Lowers the distance of cell `i` if a path through one of the four neighbours that this pass
    /// has visited is shorter. `visited(i, step)` returns the index of the visited neighbour `step`
    /// indices away from `i`.
    fn visit(&mut self, i: usize, diagonal: f64, visited: impl Fn(usize, usize) -> usize) {
        let distance_via = |step: usize| {
            let neighbour = visited(i, step);
            if self.sides[neighbour] == self.sides[i] {
                self.lengths[neighbour]
            } else {
                0.0
            }
        };
        let straight = distance_via(1).min(distance_via(self.stride)) + 1.0;
        let diagonal = distance_via(self.stride - 1).min(distance_via(self.stride + 1)) + diagonal;
        self.lengths[i] = self.lengths[i].min(straight).min(diagonal);
    }

    /// Signed distance of cell `i` from the boundary: positive inside, negative outside.
    fn signed_distance(&self, i: usize) -> f32 {
        // The boundary lies half a cell before the centre of the nearest cell on its other side.
        let distance = (self.lengths[i] - 0.5) as f32;
        if self.sides[i] { distance } else { -distance }
    }
}
