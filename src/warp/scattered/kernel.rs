//! Vectorised evaluation of the radial functions and their sums.
//!
//! The functions take the *squared* distance, which saves a square root. Each loop is compiled
//! for several vector widths and one is chosen at run time; the results are identical.

use crate::geometry::DVec2;
use crate::warp::elementary::{exp, ln};
use pulp::{Simd, WithSimd};

/// Number of points evaluated together (resource limit: their sums fit into the first-level
/// cache).
///
/// With only eight points, the compiler would unroll the loops instead of vectorising them.
const LANES: usize = 64;

/// One number per point of a block.
type SumLanes = [f64; LANES];

/// Radial function φ, evaluated from the squared distance r² and the centre's squared radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RadialKernel {
    /// φ = r² log r, where r is the distance from the centre.
    ThinPlate,
    /// φ = exp(−rate r²), where r is the distance from the centre.
    Gaussian {
        /// Reciprocal of the squared radius.
        rate: f64,
    },
    /// φ = (r² + rᵢ²)^exponent, where r is the distance from centre i, whose radius is rᵢ.
    Multiquadric {
        /// Exponent μ.
        exponent: f64,
    },
}

impl RadialKernel {
    /// Returns the sign by which the function must be multiplied to be (conditionally) positive
    /// definite.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Multiquadric { exponent } if exponent > 0.0 => -1.0,
            _ => 1.0,
        }
    }
}

/// A radial function as a type, so that loops are compiled for each function separately.
trait RadialFunction: Copy {
    /// Returns φ for a squared distance `r2` and the centre's squared radius `own`.
    fn of(self, r2: f64, own: f64) -> f64;
}

/// φ = r² log r, where r is the distance from the centre.
#[derive(Clone, Copy)]
struct ThinPlate;
/// φ = exp(−rate r²), where r is the distance from the centre; holds the rate.
#[derive(Clone, Copy)]
struct Gaussian(f64);
/// φ = √(r² + rᵢ²), where r is the distance from centre i and rᵢ the radius of centre i.
#[derive(Clone, Copy)]
struct RootKernel;
/// φ = (r² + rᵢ²)^μ, where r is the distance from centre i and rᵢ the radius of centre i; holds μ.
#[derive(Clone, Copy)]
struct PowerKernel(f64);

// These are methods with forced inlining instead of closures, because a loop with a closure that is
// not inlined is not vectorised.
impl RadialFunction for ThinPlate {
    /// Returns r² log r, which is 0 for r = 0 because this `ln` is finite there.
    #[inline(always)]
    fn of(self, r2: f64, _: f64) -> f64 {
        0.5 * r2 * ln(r2)
    }
}

impl RadialFunction for Gaussian {
    #[inline(always)]
    fn of(self, r2: f64, _: f64) -> f64 {
        exp(-self.0 * r2)
    }
}

impl RadialFunction for RootKernel {
    #[inline(always)]
    fn of(self, r2: f64, own: f64) -> f64 {
        (r2 + own).sqrt()
    }
}

impl RadialFunction for PowerKernel {
    #[inline(always)]
    fn of(self, r2: f64, own: f64) -> f64 {
        exp(self.0 * ln(r2 + own))
    }
}

/// A computation that is generic over the radial function.
trait KernelWork {
    /// Runs the computation with one radial function.
    fn run<P: RadialFunction>(self, phi: P);
}

/// A computation with its radial function, compiled once for each vector width.
pub(super) struct KernelDispatch<W>(pub(super) RadialKernel, pub(super) W);

impl<W: KernelWork> WithSimd for KernelDispatch<W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self.0 {
            RadialKernel::ThinPlate => self.1.run(ThinPlate),
            RadialKernel::Gaussian { rate } => self.1.run(Gaussian(rate)),
            // The default exponent, for which a square root is cheaper than a power.
            RadialKernel::Multiquadric { exponent: 0.5 } => self.1.run(RootKernel),
            RadialKernel::Multiquadric { exponent } => self.1.run(PowerKernel(exponent)),
        }
    }
}

/// Centres of the radial functions, in normalised coordinates.
#[derive(Clone, Debug, Default)]
pub(super) struct KernelCentres {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Squared radius rᵢ² of each centre.
    pub(super) own: Vec<f64>,
}

/// Column of the matrix ±Φ of the linear system: the radial function of centre `of`, evaluated at
/// all centres and multiplied by `sign`.
pub(super) struct KernelColumn<'a> {
    pub(super) centres: &'a KernelCentres,
    pub(super) of: usize,
    pub(super) sign: f64,
    pub(super) out: &'a mut [f64],
}

impl KernelWork for KernelColumn<'_> {
    #[inline(always)]
    fn run<P: RadialFunction>(self, phi: P) {
        let KernelCentres { x, y, own } = self.centres;
        let (x0, y0, own) = (x[self.of], y[self.of], own[self.of]);
        for ((out, x), y) in self.out.iter_mut().zip(x).zip(y) {
            let (dx, dy) = (x - x0, y - y0);
            *out = self.sign * phi.of(dx * dx + dy * dy, own);
        }
    }
}

/// For each design, the displacement from a point of the frame to the corresponding point of the
/// design: a sum of radial functions plus an affine function.
#[derive(Clone, Debug)]
pub(super) struct RadialSum {
    pub(super) kernel: RadialKernel,
    /// Origin of the normalised coordinates (point − origin) / scale.
    pub(super) origin: DVec2,
    /// Scale of the normalised coordinates.
    pub(super) scale: f64,
    pub(super) centres: KernelCentres,
    /// For each centre, the coefficient of its radial function: one vector [x, y] per design.
    pub(super) coefficients: Vec<[[f64; 2]; 2]>,
    /// For each design, the affine function: the constant term, the coefficient of x and the
    /// coefficient of y, each as a vector [x, y].
    pub(super) affine: [[[f64; 2]; 3]; 2],
}

impl RadialSum {
    /// Writes each point plus its displacement, for both designs.
    pub(super) fn evaluate(&self, arch: pulp::Arch, places: &[DVec2], out: [&mut [DVec2]; 2]) {
        arch.dispatch(KernelDispatch(
            self.kernel,
            SumEvaluation(self, places, out),
        ));
    }

    /// Computes the displacements of up to [`LANES`] points, given in normalised coordinates.
    #[inline(always)]
    fn block<P: RadialFunction>(
        &self,
        phi: P,
        x: &[f64],
        y: &[f64],
        sums: &mut [[SumLanes; 2]; 2],
    ) {
        let n = x.len().min(LANES);
        let (x, y) = (&x[..n], &y[..n]);
        for (sums, [constant, by_x, by_y]) in sums.iter_mut().zip(&self.affine) {
            for (axis, sums) in sums.iter_mut().enumerate() {
                for ((sum, x), y) in sums[..n].iter_mut().zip(x).zip(y) {
                    *sum = constant[axis] + (by_x[axis] * x + by_y[axis] * y);
                }
            }
        }
        let KernelCentres { x: xs, y: ys, own } = &self.centres;
        let centres = xs.iter().zip(ys).zip(own).zip(&self.coefficients);
        let mut values = [0.0; LANES];
        let values = &mut values[..n];
        for (((&x0, &y0), &own), coefficients) in centres {
            for ((value, x), y) in values.iter_mut().zip(x).zip(y) {
                let (dx, dy) = (x - x0, y - y0);
                *value = phi.of(dx * dx + dy * dy, own);
            }
            for (sums, coefficients) in sums.iter_mut().zip(coefficients) {
                for (sums, &coefficient) in sums.iter_mut().zip(coefficients) {
                    for (sum, value) in sums[..n].iter_mut().zip(&*values) {
                        *sum += coefficient * value;
                    }
                }
            }
        }
    }
}

/// Evaluation of a [`RadialSum`] at a list of points, for both designs.
struct SumEvaluation<'a>(&'a RadialSum, &'a [DVec2], [&'a mut [DVec2]; 2]);

impl KernelWork for SumEvaluation<'_> {
    #[inline(always)]
    fn run<P: RadialFunction>(self, phi: P) {
        let Self(sum, places, mut out) = self;
        let [mut x, mut y] = [[0.0; LANES]; 2];
        let mut sums = [[[0.0; LANES]; 2]; 2];
        for (block, places) in places.chunks(LANES).enumerate() {
            for (lane, &place) in places.iter().enumerate() {
                let at = (place - sum.origin) / sum.scale;
                (x[lane], y[lane]) = (at.x, at.y);
            }
            let n = places.len();
            sum.block(phi, &x[..n], &y[..n], &mut sums);
            for (out, [x, y]) in out.iter_mut().zip(&sums) {
                let out = &mut out[block * LANES..];
                for (lane, (&place, out)) in places.iter().zip(out).enumerate() {
                    *out = place + DVec2::new(x[lane], y[lane]);
                }
            }
        }
    }
}
