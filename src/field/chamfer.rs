//! Signed distance transforms whose balls are octagons: city-block, chessboard
//! and quasi-Euclidean.
//!
//! Two passes over the picture, each looking at four neighbours (Rosenfeld and
//! Pfaltz 1966, Montanari 1968, Borgefors 1986). A shortest way of straight and
//! diagonal steps can always be put in an order that the two passes follow, so
//! that the results are exact in these metrics, up to the rounding of √2. As
//! in the Euclidean transform both signs come out of one sweep: a neighbour of
//! the other side is at distance 0.

use super::Mask;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use std::ops::Range;

/// Rows between two looks at whether the work was cancelled.
const ROWS: usize = 64;

/// Signed distances of all cells of `mask`, where a step along an axis is 1
/// long and one along a diagonal `diagonal`.
pub(super) fn distances(
    mask: &Mask,
    diagonal: f64,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Cancelled> {
    let height = mask.height() as usize;
    let mut lengths = ChamferWeights::of(mask);
    let report = |done: usize| {
        let fraction = 0.5 * done as f64 / height as f64;
        checkpoint(progress, "measuring distances", fraction)
    };
    for y in 0..height {
        if y % ROWS == 0 {
            report(y)?;
        }
        let row = lengths.row(y);
        // Behind lie the cell to the left and the three below.
        row.for_each(|i| lengths.visit(i, diagonal, |i, step| i - step));
    }
    for y in (0..height).rev() {
        if y % ROWS == 0 {
            report(2 * height - 1 - y)?;
        }
        let row = lengths.row(y).rev();
        row.for_each(|i| lengths.visit(i, diagonal, |i, step| i + step));
    }
    let cells = (0..height).flat_map(|y| lengths.row(y));
    Ok(cells.map(|i| lengths.signed(i)).collect())
}

/// Sides and unsigned distances, with the ring of outside cells around the
/// picture.
struct ChamferWeights {
    sides: Vec<bool>,
    lengths: Vec<f64>,
    /// Cells in a row, ring included.
    stride: usize,
}

impl ChamferWeights {
    /// The sides, and no distance yet.
    fn of(mask: &Mask) -> Self {
        let (width, height) = (mask.width() as usize, mask.height() as usize);
        // A ring of outside cells, so that no cell asks whether it has
        // neighbours.
        let stride = width + 2;
        let cells = stride * (height + 2);
        let mut found = Self {
            sides: vec![false; cells],
            lengths: vec![f64::INFINITY; cells],
            stride,
        };
        for (y, bits) in mask.bits().chunks_exact(width).enumerate() {
            let row = found.row(y);
            found.sides[row].copy_from_slice(bits);
        }
        found
    }

    /// Indices of the cells in row `y` of the picture.
    fn row(&self, y: usize) -> Range<usize> {
        let first = (y + 1) * self.stride + 1;
        first..first + self.stride - 2
    }

    /// Lowers the distance of cell `i` by way of the four neighbours that the
    /// pass has behind it.
    fn visit(&mut self, i: usize, diagonal: f64, behind: impl Fn(usize, usize) -> usize) {
        let by = |step: usize| {
            let neighbour = behind(i, step);
            if self.sides[neighbour] == self.sides[i] {
                self.lengths[neighbour]
            } else {
                0.0
            }
        };
        let straight = by(1).min(by(self.stride)) + 1.0;
        let diagonal = by(self.stride - 1).min(by(self.stride + 1)) + diagonal;
        self.lengths[i] = self.lengths[i].min(straight).min(diagonal);
    }

    fn signed(&self, i: usize) -> f32 {
        // The boundary runs half a cell before the nearest cell of the other
        // side.
        let distance = (self.lengths[i] - 0.5) as f32;
        if self.sides[i] { distance } else { -distance }
    }
}
