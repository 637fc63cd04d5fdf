//! Linear system for the coefficients of the radial functions and the affine part.
//!
//! First, in normalised coordinates, the best-fit similarity is subtracted from the displacements
//! of the centres. The remaining displacements r are interpolated (Wahba, "Spline Models for
//! Observational Data", 1990, §2.4):
//!
//! ⎡ ±Φ + λI   P ⎤ ⎡c⎤   ⎡r⎤
//! ⎣ Pᵀ       −E ⎦ ⎣a⎦ = ⎣0⎦
//!
//! c are the coefficients of the radial functions, a those of the affine part, and λ is the
//! smoothing parameter. Φ holds the radial functions at the centres; the sign is the one that makes
//! ±Φ positive definite on the null space of Pᵀ. P has the columns 1, x, y.
//!
//! E is a tiny regularisation. Fewer than three centres, or collinear ones, leave some slopes of
//! the affine part undetermined; with E, these slopes become those of the similarity. Two points
//! thus give a similarity and one a translation without any special case. If the centres nearly lie
//! on a line and their displacements require a steep slope across it, E grows and limits that slope
//! continuously.
//!
//! For each pair of close centres (`centres`), a coupling μ is added to the two diagonal entries of
//! ±Φ for these centres and subtracted from the two entries that combine them. A large μ forces
//! equal coefficients, as if the two centres were one. If the matrix is numerically singular, as
//! for Gaussians much wider than the distances between the centres, a ridge is added to the
//! diagonal.

use super::centres::{CentreData, MAX_SLOPE};
use super::kernel::{KernelCentres, KernelColumn, KernelDispatch, RadialKernel, RadialSum};
use super::options::{RadialBasis, ScatteredOptions};
use crate::geometry::DVec2;
use crate::numerics::DenseLu;
use pulp::Arch;

/// Smallest value of E, the regularisation of the affine slopes (tolerance: affine maps are
/// reproduced to 1e-12 by centres whose spread in one direction is a tenth of that in the other).
const MIN_SLACK: f64 = 1e-13;

/// Largest value added to E, the regularisation of the affine slopes.
///
/// Derived: for centres within a unit circle the system of r² log r stays positive definite
/// (Williams and Fitzgibbon, "Gaussian process implicit surfaces", 2006, eq. 9 with R = 2: E ≤ 1 /
/// (1 + 2 log 2)).
const MAX_SLACK: f64 = 0.4;

/// Ridges: numbers of which the smallest that makes the system solvable is added to the diagonal of
/// ±Φ, the matrix of the radial functions at the centres (tolerance: from the size of rounding
/// errors to the largest acceptable error).
const RIDGES: [f64; 7] = [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// Residual of the solved system, relative to the largest displacement, above which the next larger
/// ridge is tried (tolerance: far below a pixel).
const MAX_RESIDUAL: f64 = 1e-9;

/// Solver for the coefficients at one t after another, with reusable memory.
#[derive(Debug)]
pub(super) struct RadialSolver {
    pub(super) arch: Arch,
    options: ScatteredOptions,
    /// Diameter of the frame: the unit of width, smoothing and merge distance.
    unit: f64,
    places: CentreData,
    system: RidgedSystem,
    /// Result of the most recent call of [`Self::solve`].
    pub(super) sum: RadialSum,
}

/// A clone has its own, empty memory.
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

    /// Computes `sum` for the given features. Each feature has a position in the frame and the
    /// displacements to its positions in source and target, all finite. Cannot fail.
    pub(super) fn solve(&mut self, features: impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone) {
        self.places.merge(features, self.unit);
        self.places.limit_slopes();
        self.places.normalise(self.unit, &mut self.sum);
        self.sum.affine = self.places.remove_similarity();
        self.sum.kernel = self.kernel();
        let n = self.places.positions.len();
        self.sum.coefficients.clear();
        self.sum.coefficients.resize(n, [[0.0; 2]; 2]);
        // If the similarity alone explains all displacements, as for a single feature, nothing is
        // left to solve.
        let mut remainders = self.places.values.iter().flatten();
        if remainders.any(|r| *r != DVec2::ZERO) {
            self.assemble();
            self.system.set_right_hand_sides(&self.places.values);
            // If the system cannot be solved with any ridge, `sum` is the similarity alone.
            if self.system.solve(n) {
                self.store_solution();
            }
        }
    }

    /// Returns the radial function in normalised coordinates.
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

    /// Returns the smoothing parameter λ in normalised coordinates.
    ///
    /// Normalisation multiplies the radial functions by a constant factor, apart from polynomials
    /// that the affine part absorbs.
    fn smoothing(&self) -> f64 {
        let ratio = self.unit / self.sum.scale;
        let factor = match self.options.basis {
            RadialBasis::ThinPlate => ratio * ratio,
            RadialBasis::Gaussian => 1.0,
            RadialBasis::Multiquadric => ratio.powf(2.0 * self.options.exponent),
        };
        // The value is capped so that the matrix entries stay well within range.
        (self.options.smoothing * factor).min(1e12)
    }

    /// Returns the entries [xx, xy, yy] of the regularisation E for the slopes in x and y.
    ///
    /// E is [`MIN_SLACK`] in every direction. If the centres nearly lie on a line and their
    /// displacements require a slope above [`MAX_SLOPE`] across it, E is larger in that direction.
    fn admissible_slack(&self) -> [f64; 3] {
        let n = self.places.positions.len().max(1) as f64;
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for p in &self.places.positions {
            xx += p.x * p.x / n;
            xy += p.x * p.y / n;
            yy += p.y * p.y / n;
        }
        let half = 0.5 * (xx - yy);
        let across = (0.5 * (xx + yy) - half.hypot(xy)).max(0.0);
        let variances = (0..2).map(|k| {
            self.places
                .values
                .iter()
                .map(|v| v[k].length_squared())
                .sum()
        });
        let variance = variances.fold(0.0, f64::max) / n;
        let slope = MAX_SLOPE * self.sum.scale;
        let added = (variance / (slope * slope) - across).clamp(0.0, MAX_SLACK);
        let axis = DVec2::from_angle(0.5 * xy.atan2(half)).perp();
        [
            MIN_SLACK + added * axis.x * axis.x,
            added * axis.x * axis.y,
            MIN_SLACK + added * axis.y * axis.y,
        ]
    }

    /// Assembles the matrix of the linear system column by column.
    fn assemble(&mut self) {
        let n = self.places.positions.len();
        let size = n + 3;
        self.system.matrix.clear();
        self.system.matrix.resize(size * size, 0.0);
        let kernel = self.sum.kernel;
        let sign = kernel.sign();
        let columns = self.system.matrix.chunks_exact_mut(size);
        for (of, (entries, p)) in columns.zip(&self.places.positions).enumerate() {
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
        for (i, p) in self.places.positions.iter().enumerate() {
            for (k, value) in [1.0, p.x, p.y].into_iter().enumerate() {
                self.system.matrix[(n + k) * size + i] = value;
            }
        }
        self.couple_close_pairs();
        let lambda = self.smoothing();
        for i in 0..n {
            self.system.matrix[i * size + i] += lambda;
        }
        let [xx, xy, yy] = self.admissible_slack();
        for (i, j, e) in [(1, 1, xx), (1, 2, xy), (2, 1, xy), (2, 2, yy)] {
            self.system.matrix[(n + j) * size + n + i] = -e;
        }
    }

    /// Adds the weight μ of each close pair to the matrix, which pulls the coefficients of the two
    /// centres together. μ is the product of 1 / `shrink_factor` − 1 and `bounded`. The number
    /// `bounded` is the absolute value of the matrix's quadratic form for the coefficients 1/√2 and
    /// −1/√2 at the two centres, plus the squared distance between the centres.
    fn couple_close_pairs(&mut self) {
        let size = self.places.positions.len() + 3;
        for near in &mut self.places.close_pairs {
            let [i, j] = near.pair;
            let entry = |i: usize, j: usize| self.system.matrix[j * size + i];
            let energy = 0.5 * (entry(i, i) + entry(j, j) - entry(i, j) - entry(j, i));
            // For wide Gaussians `energy` may vanish; the squared distance keeps the sum positive.
            let bounded =
                energy.abs() + self.places.positions[i].distance_squared(self.places.positions[j]);
            near.coupling = (bounded * (1.0 / near.shrink_factor - 1.0)).min(1e12);
        }
        for near in &self.places.close_pairs {
            let [i, j] = near.pair;
            for (i, j, mu) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                self.system.matrix[j * size + i] += mu * near.coupling;
            }
        }
    }

    /// Copies the solution into `sum` and multiplies the coefficients by the sign of the radial
    /// function.
    fn store_solution(&mut self) {
        let n = self.places.positions.len();
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

/// Dense linear system. The smallest sufficient ridge is added to the diagonal of its block ±Φ.
#[derive(Debug, Default)]
struct RidgedSystem {
    /// Entries of the system's matrix, column by column.
    matrix: Vec<f64>,
    /// Four right-hand sides one after the other: x and y for each design.
    rhs: Vec<f64>,
    /// Four solutions, in the layout of `rhs`.
    solution: Vec<f64>,
    /// Memory for the residual of one right-hand side.
    residual: Vec<f64>,
    lu: DenseLu,
}

impl RidgedSystem {
    /// Sets the right-hand sides from the displacements of the centres, with zeros in the three
    /// rows of the affine part.
    fn set_right_hand_sides(&mut self, values: &[[DVec2; 2]]) {
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

    /// Solves for n coefficients and an affine part, trying [`RIDGES`] in turn.
    ///
    /// Returns `false` if even the largest ridge leaves too large a residual.
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
            self.is_solved(size)
        })
    }

    /// Returns whether the residuals of the solution are within [`MAX_RESIDUAL`].
    fn is_solved(&mut self, size: usize) -> bool {
        let largest = self.rhs.iter().fold(0.0_f64, |max, v| max.max(v.abs()));
        let columns = self.rhs.chunks_exact(size);
        let mut columns = columns.zip(self.solution.chunks_exact(size));
        columns.all(|(rhs, solution)| {
            let residual = &mut self.residual;
            residual.clear();
            residual.extend_from_slice(rhs);
            for (&x, entries) in solution.iter().zip(self.matrix.chunks_exact(size)) {
                for (r, entry) in residual.iter_mut().zip(entries) {
                    *r -= x * entry;
                }
            }
            // The comparison is false for NaN too.
            residual.iter().all(|r| r.abs() <= MAX_RESIDUAL * largest)
        })
    }
}
