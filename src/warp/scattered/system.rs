//! What is solved for: coefficients and an affine part from places and values.
//!
//! In coordinates that are centred on the places and scaled by their extent,
//! the best similarity is taken off first. What it leaves of the values, r, is
//! interpolated by (Wahba, "Spline Models for Observational Data", 1990,
//! §2.4)
//!
//! ⎡ ±Φ + λI   P ⎤ ⎡c⎤   ⎡r⎤
//! ⎣ Pᵀ       −E ⎦ ⎣a⎦ = ⎣0⎦
//!
//! with Φ the radial functions at the places, signed so that it is positive
//! definite on the null space of Pᵀ, and P the columns 1, x, y. E is 0 but for
//! a trifle: where the places leave a slope undetermined, since there are
//! fewer than three or all on a line, that slope is 0 beyond the similarity's.
//! So two points give a similarity and one a translation, with no case of
//! their own. Where places come near a line that the values have nothing to do
//! with, E grows, and the slope across stays below a limit without a jump.
//!
//! Where two places come too near for what their values are (`places`), μ is
//! added to Φ at both and taken from it between them. A large μ leaves the sum
//! of their coefficients free and their difference 0, as if they were one.
//!
//! Places that coincide are one, at their mean and with the mean of their
//! values. Where the matrix is singular to the last digits, as it is for
//! Gaussians far wider than their distances, a ridge is added.

use super::centres::{CentreData, STEEPEST};
use super::kernel::{KernelCentres, KernelColumn, KernelDispatch, RadialKernel, RadialSum};
use super::options::{RadialBasis, ScatteredOptions};
use crate::geometry::DVec2;
use crate::numerics::DenseLu;
use pulp::Arch;

/// The least of E: at 1e-13 an affine map is met to 1e-12 by places whose
/// spread across is a tenth of that along.
const LEAST: f64 = 1e-13;

/// The most of E: for places in a circle of radius 1, r² log r is positive
/// definite beside it (Williams and Fitzgibbon, "Gaussian process implicit
/// surfaces", 2006, eq. 9 with R = 2: E ≤ 1 / (1 + 2 log 2)).
const MOST: f64 = 0.4;

/// What is added to the diagonal, from attempt to attempt.
const RIDGES: [f64; 7] = [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// The share of the values that a solution may miss before a ridge is added.
const MISSED: f64 = 1e-9;

/// Solves again and again in the same memory.
#[derive(Debug)]
pub(super) struct RadialSolver {
    pub(super) arch: Arch,
    options: ScatteredOptions,
    /// What width, smoothing and merging are relative to.
    unit: f64,
    places: CentreData,
    system: RidgedSystem,
    /// The last solution.
    pub(super) sum: RadialSum,
}

/// Memory of its own, as empty as that of a new one.
impl Clone for RadialSolver {
    fn clone(&self) -> Self {
        Self::new(self.options, self.unit)
    }
}

impl RadialSolver {
    pub(super) fn new(options: ScatteredOptions, unit: f64) -> Self {
        Self {
            arch: Arch::new(),
            options,
            unit,
            places: CentreData::default(),
            system: RidgedSystem::default(),
            sum: RadialSum {
                kernel: RadialKernel::ThinPlate,
                origin: DVec2::ZERO,
                scale: 1.0,
                centres: KernelCentres::default(),
                coefficients: Vec::new(),
                affine: [[[0.0; 2]; 3]; 2],
            },
        }
    }

    /// Solves for finite places and values; cannot fail.
    pub(super) fn solve(&mut self, features: impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone) {
        self.places.merge(features, self.unit);
        self.places.ease();
        self.places.centre(self.unit, &mut self.sum);
        self.sum.affine = self.places.take_similarity();
        self.sum.kernel = self.kernel();
        let n = self.places.at.len();
        self.sum.coefficients.clear();
        self.sum.coefficients.resize(n, [[0.0; 2]; 2]);
        // Of one feature nothing is left; a solve for zeros is spared.
        let mut looks = self.places.values.iter().flatten();
        if looks.any(|r| *r != DVec2::ZERO) {
            self.assemble();
            self.system.ask(&self.places.values);
            // Where nothing helps, the similarity alone is left.
            if self.system.solve(n) {
                self.keep();
            }
        }
    }

    /// The function in the coordinates that are scaled.
    fn kernel(&self) -> RadialKernel {
        match self.options.basis {
            RadialBasis::ThinPlate => RadialKernel::ThinPlate,
            RadialBasis::Gaussian => {
                let radius = self.options.width * self.unit / self.sum.scale;
                RadialKernel::Gaussian {
                    rate: 1.0 / (radius * radius),
                }
            }
            RadialBasis::Multiquadric => RadialKernel::Multiquadric {
                exponent: self.options.exponent,
            },
        }
    }

    /// λ in the coordinates that are scaled: the functions there are those of
    /// the unit but for a factor, and polynomials that the affine part takes.
    fn smoothing(&self) -> f64 {
        let shrunk = self.unit / self.sum.scale;
        let factor = match self.options.basis {
            RadialBasis::ThinPlate => shrunk * shrunk,
            RadialBasis::Gaussian => 1.0,
            RadialBasis::Multiquadric => shrunk.powf(2.0 * self.options.exponent),
        };
        (self.options.smoothing * factor).min(1e12)
    }

    /// E as xx, xy, yy: [`LEAST`], and more across a line that places are
    /// nearer to than the values allow.
    fn slack(&self) -> [f64; 3] {
        let n = self.places.at.len().max(1) as f64;
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for p in &self.places.at {
            xx += p.x * p.x / n;
            xy += p.x * p.y / n;
            yy += p.y * p.y / n;
        }
        let half = 0.5 * (xx - yy);
        let across = (0.5 * (xx + yy) - half.hypot(xy)).max(0.0);
        let left = (0..2).map(|k| {
            self.places
                .values
                .iter()
                .map(|v| v[k].length_squared())
                .sum()
        });
        let left = left.fold(0.0, f64::max) / n;
        let slope = STEEPEST * self.sum.scale;
        let more = (left / (slope * slope) - across).clamp(0.0, MOST);
        let axis = DVec2::from_angle(0.5 * xy.atan2(half)).perp();
        [
            LEAST + more * axis.x * axis.x,
            more * axis.x * axis.y,
            LEAST + more * axis.y * axis.y,
        ]
    }

    /// The matrix column by column, with λ on the diagonal.
    fn assemble(&mut self) {
        let n = self.places.at.len();
        let size = n + 3;
        self.system.matrix.clear();
        self.system.matrix.resize(size * size, 0.0);
        let kernel = self.sum.kernel;
        let sign = kernel.sign();
        let columns = self.system.matrix.chunks_exact_mut(size);
        for (of, (entries, p)) in columns.zip(&self.places.at).enumerate() {
            let (out, affine) = entries.split_at_mut(n);
            let centres = &self.sum.centres;
            let column = KernelColumn {
                centres,
                of,
                sign,
                out,
            };
            self.arch.dispatch(KernelDispatch(kernel, column));
            affine.copy_from_slice(&[1.0, p.x, p.y]);
        }
        for (i, p) in self.places.at.iter().enumerate() {
            for (k, value) in [1.0, p.x, p.y].into_iter().enumerate() {
                self.system.matrix[(n + k) * size + i] = value;
            }
        }
        self.tie();
        let lambda = self.smoothing();
        for i in 0..n {
            self.system.matrix[i * size + i] += lambda;
        }
        let [xx, xy, yy] = self.slack();
        for (i, j, e) in [(1, 1, xx), (1, 2, xy), (2, 1, xy), (2, 2, yy)] {
            self.system.matrix[(n + j) * size + n + i] = -e;
        }
    }

    /// Adds μ for places that are too near: (1 / shrunk − 1) times what two
    /// opposite coefficients cost without it, or more where that may vanish.
    fn tie(&mut self) {
        let size = self.places.at.len() + 3;
        for near in &mut self.places.too_near {
            let [i, j] = near.pair;
            let entry = |i: usize, j: usize| self.system.matrix[j * size + i];
            let cost = 0.5 * (entry(i, i) + entry(j, j) - entry(i, j) - entry(j, i));
            // What two opposite coefficients cost may vanish for wide Gaussians.
            let cost = cost.abs() + self.places.at[i].distance_squared(self.places.at[j]);
            near.tie = (cost * (1.0 / near.shrunk - 1.0)).min(1e12);
        }
        for near in &self.places.too_near {
            let [i, j] = near.pair;
            for (i, j, mu) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                self.system.matrix[j * size + i] += mu * near.tie;
            }
        }
    }

    /// Takes the solution over, the functions' sign included.
    fn keep(&mut self) {
        let n = self.places.at.len();
        let size = n + 3;
        let sign = self.sum.kernel.sign();
        for (row, solution) in self.system.solution.chunks_exact(size).enumerate() {
            let (k, axis) = (row / 2, row % 2);
            for (c, value) in self.sum.coefficients.iter_mut().zip(&solution[..n]) {
                c[k][axis] = sign * value;
            }
            for (a, value) in self.sum.affine[k].iter_mut().zip(&solution[n..]) {
                a[axis] += value;
            }
        }
    }
}

/// A full system, solved with as small a ridge as does.
#[derive(Debug, Default)]
struct RidgedSystem {
    /// Column by column.
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// One column after the other: x and y into each design.
    solution: Vec<f64>,
    missed: Vec<f64>,
    lu: DenseLu,
}

impl RidgedSystem {
    /// Sets the right-hand sides: x and y into each design, and zeros where the
    /// affine part has none.
    fn ask(&mut self, values: &[[DVec2; 2]]) {
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
    fn solve(&mut self, n: usize) -> bool {
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
