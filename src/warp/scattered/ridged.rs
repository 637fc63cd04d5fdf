//! A full system, solved with as small a ridge as does.

use crate::geometry::DVec2;
use crate::linalg::DenseLu;

/// What is added to the diagonal, from attempt to attempt.
const RIDGES: [f64; 7] = [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// The share of the values that a solution may miss before a ridge is added.
const MISSED: f64 = 1e-9;

/// Solves again and again in the same memory.
#[derive(Debug, Default)]
pub(super) struct Ridged {
    /// Column by column.
    pub(super) matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// One column after the other: x and y into each design.
    pub(super) solution: Vec<f64>,
    missed: Vec<f64>,
    lu: DenseLu,
}

impl Ridged {
    /// Sets the right-hand sides: x and y into each design, and zeros where the
    /// affine part has none.
    pub(super) fn ask(&mut self, values: &[[DVec2; 2]]) {
        let size = values.len() + 3;
        self.rhs.clear();
        self.rhs.resize(size * 4, 0.0);
        for (i, value) in values.iter().enumerate() {
            for (k, v) in value.iter().enumerate() {
                self.rhs[2 * k * size + i] = v.x;
                self.rhs[(2 * k + 1) * size + i] = v.y;
            }
        }
    }

    /// Solves for n coefficients and an affine part, with the least addition
    /// to the diagonal of the coefficients; `false` where nothing helped.
    pub(super) fn solve(&mut self, n: usize) -> bool {
        let size = n + 3;
        let mut before = 0.0;
        RIDGES.into_iter().any(|ridge| {
            for i in 0..n {
                self.matrix[i * size + i] += ridge - before;
            }
            before = ridge;
            self.lu.factor(size, &self.matrix);
            self.solution.clear();
            self.solution.extend_from_slice(&self.rhs);
            self.lu.solve(&mut self.solution);
            self.solves(size)
        })
    }

    /// Whether the solution misses the values by little.
    fn solves(&mut self, size: usize) -> bool {
        let largest = self.rhs.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let columns = self.rhs.chunks_exact(size);
        let mut columns = columns.zip(self.solution.chunks_exact(size));
        columns.all(|(rhs, solution)| {
            let missed = &mut self.missed;
            missed.clear();
            missed.extend_from_slice(rhs);
            for (&x, entries) in solution.iter().zip(self.matrix.chunks_exact(size)) {
                for (missed, entry) in missed.iter_mut().zip(entries) {
                    *missed -= x * entry;
                }
            }
            // False for NaN as well.
            missed.iter().all(|r| r.abs() <= MISSED * largest)
        })
    }
}
