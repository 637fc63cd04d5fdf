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
use crate::progress::{Cancelled, Progress, checkpoint};
use std::ops::Range;

/// Rows between two looks at whether the work was cancelled.
const ROWS: usize = 64;

/// Lengths of a step along an axis and of a step along a diagonal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    pub(super) straight: f64,
    pub(super) diagonal: f64,
}

/// Sides and unsigned distances, with the ring of outside cells around the
/// picture; kept between transforms.
#[derive(Clone, Debug, Default)]
pub(super) struct Lengths {
    sides: Vec<bool>,
    lengths: Vec<f64>,
    /// Cells in a row, ring included.
    stride: usize,
}

impl Lengths {
    /// Measures `mask`, and writes signed distances into `out` of its length.
    pub(super) fn transform(
        &mut self,
        mask: &Mask,
        steps: Steps,
        out: &mut [f32],
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        let height = mask.height() as usize;
        self.read(mask);
        let report = |done: usize| {
            let fraction = 0.5 * done as f64 / height as f64;
            checkpoint(progress, "measuring distances", fraction)
        };
        for y in 0..height {
            if y % ROWS == 0 {
                report(y)?;
            }
            let row = self.row(y);
            row.for_each(|i| self.visit(i, steps, |i, step| i - step));
        }
        for y in (0..height).rev() {
            if y % ROWS == 0 {
                report(2 * height - 1 - y)?;
            }
            let row = self.row(y).rev();
            row.for_each(|i| self.visit(i, steps, |i, step| i + step));
        }
        self.write(out);
        Ok(())
    }

    /// Sets the sides, and no distance yet.
    fn read(&mut self, mask: &Mask) {
        let (width, height) = (mask.width() as usize, mask.height() as usize);
        self.stride = width + 2;
        let cells = self.stride * (height + 2);
        self.sides.clear();
        self.sides.resize(cells, false);
        self.lengths.clear();
        self.lengths.resize(cells, f64::INFINITY);
        for (y, bits) in mask.bits().chunks_exact(width).enumerate() {
            let row = self.row(y);
            self.sides[row].copy_from_slice(bits);
        }
    }

    /// Indices of the cells in row `y` of the picture.
    fn row(&self, y: usize) -> Range<usize> {
        let first = (y + 1) * self.stride + 1;
        first..first + self.stride - 2
    }

    /// Lowers the distance of cell `i` by way of the four neighbours that the
    /// pass has behind it.
    fn visit(&mut self, i: usize, steps: Steps, behind: impl Fn(usize, usize) -> usize) {
        let by = |step: usize| {
            let neighbour = behind(i, step);
            if self.sides[neighbour] == self.sides[i] {
                self.lengths[neighbour]
            } else {
                0.0
            }
        };
        let straight = by(1).min(by(self.stride)) + steps.straight;
        let diagonal = by(self.stride - 1).min(by(self.stride + 1)) + steps.diagonal;
        self.lengths[i] = self.lengths[i].min(straight).min(diagonal);
    }

    fn write(&self, out: &mut [f32]) {
        for (y, out) in out.chunks_exact_mut(self.stride - 2).enumerate() {
            for (out, i) in out.iter_mut().zip(self.row(y)) {
                let distance = (self.lengths[i] - 0.5) as f32;
                *out = if self.sides[i] { distance } else { -distance };
            }
        }
    }
}
