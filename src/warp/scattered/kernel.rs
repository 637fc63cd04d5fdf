//! The radial functions, many distances at a time.
//!
//! All take the *squared* distance, which spares a root. Each loop is
//! compiled for several widths of vectors and one is chosen at run time; the
//! results are the same for all.

use crate::geometry::DVec2;
use crate::warp::elementary::{exp, ln};
use pulp::{Simd, WithSimd};

/// How many places are worked on at a time: their sums stay in the nearest
/// cache. Loops over eight, known beforehand, would be unrolled before they
/// are made into vectors.
const LANES: usize = 64;

type SumLanes = [f64; LANES];

/// A radial function φ of r² and of the centre's own radius squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RadialKernel {
    /// r² log r.
    ThinPlate,
    /// exp(−rate r²).
    Gaussian {
        /// One over the radius squared.
        rate: f64,
    },
    /// (r² + r_i²)^exponent.
    Multiquadric {
        /// μ.
        exponent: f64,
    },
}

impl RadialKernel {
    /// With this sign it is positive definite, if conditionally.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Multiquadric { exponent } if exponent > 0.0 => -1.0,
            _ => 1.0,
        }
    }
}

/// One of the functions, to compile a loop for.
trait RadialFunction: Copy {
    fn of(self, r2: f64, own: f64) -> f64;
}

#[derive(Clone, Copy)]
struct ThinPlate;
#[derive(Clone, Copy)]
struct Gaussian(f64);
#[derive(Clone, Copy)]
struct RootKernel;
#[derive(Clone, Copy)]
struct PowerKernel(f64);

// Methods that are inlined always, not closures: what stays a call is compiled
// for no vectors.
impl RadialFunction for ThinPlate {
    /// 0 at 0, since the logarithm is finite there.
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

/// What is done with a function once it is known.
trait KernelWork {
    fn run<P: RadialFunction>(self, phi: P);
}

/// A work and its function, to be compiled for several widths of vectors.
pub(super) struct KernelDispatch<W>(pub(super) RadialKernel, pub(super) W);

impl<W: KernelWork> WithSimd for KernelDispatch<W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self.0 {
            RadialKernel::ThinPlate => self.1.run(ThinPlate),
            RadialKernel::Gaussian { rate } => self.1.run(Gaussian(rate)),
            // The exponent of Ruprecht and Müller: a root is cheaper.
            RadialKernel::Multiquadric { exponent: 0.5 } => self.1.run(RootKernel),
            RadialKernel::Multiquadric { exponent } => self.1.run(PowerKernel(exponent)),
        }
    }
}

/// Where the functions sit, in coordinates of their own.
#[derive(Clone, Debug, Default)]
pub(super) struct KernelCentres {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Each centre's own radius squared.
    pub(super) own: Vec<f64>,
}

/// φ of one centre at all centres, times `sign`.
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

/// A sum of functions and an affine map, into both designs at once.
#[derive(Clone, Debug)]
pub(super) struct RadialSum {
    pub(super) kernel: RadialKernel,
    /// The centres' coordinates are (place − origin) / scale.
    pub(super) origin: DVec2,
    pub(super) scale: f64,
    pub(super) centres: KernelCentres,
    /// Of each centre, as [x, y] into each design.
    pub(super) coefficients: Vec<[[f64; 2]; 2]>,
    /// Constant, and factors of both coordinates, as [x, y] of each.
    pub(super) affine: [[[f64; 2]; 3]; 2],
}

impl RadialSum {
    /// Each place, moved by the sum there.
    pub(super) fn evaluate(&self, arch: pulp::Arch, places: &[DVec2], out: [&mut [DVec2]; 2]) {
        arch.dispatch(KernelDispatch(
            self.kernel,
            SumEvaluation(self, places, out),
        ));
    }

    /// The sums at a few places, in the centres' coordinates.
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

/// A sum at places, to be written into both designs.
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
