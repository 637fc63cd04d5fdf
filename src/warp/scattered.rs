//! Scattered-point warp: interpolation of pins with radial basis functions.
//!
//! Ruprecht, Müller, "Image warping with scattered data interpolation" (1995); thin plates after
//! Duchon (1977) and Bookstein, "Principal warps" (1989). At time t, a feature with position p in
//! the source and q in the target lies at (1−t) p + t q. Two mappings lead from there to the source
//! and to the target. Each mapping adds an affine function and Σ cᵢ φ(|x − xᵢ|) to the identity,
//! where φ is a radial function and xᵢ are the feature positions at t (centres), such that every
//! feature is mapped to its position in the design. Both mappings have the same centres, so one
//! factorisation per t suffices.
//!
//! Guaranteed: evaluation cannot fail. At t = 0 the mapping to the source is exactly the identity;
//! at t = 1 the mapping to the target is. Without smoothing, every feature is mapped to its
//! position, unless two features are so close together that this would require a slope above 20. In
//! that case their displacements approach each other, continuously in t, and agree when the
//! features meet (`centres`). Exchanging the designs reverses the motion. Without features the
//! mapping is the identity, with one feature a translation, and with two a similarity.
//!
//! Not guaranteed: absence of folds; [`super::Lattice`] guarantees that.
//!
//! - `options`: choice and parameters of the radial function
//! - `centres`: preparation of the features, including those that nearly meet
//! - `system`: the linear system and its regularisation
//! - `kernel`: vectorised evaluation of the radial functions

mod centres;
mod kernel;
mod options;
mod system;

#[cfg(test)]
mod tests;

pub use options::{RadialBasis, ScatteredError, ScatteredOptions};

use super::features::WarpFeatures;
use super::plane::{PlaneWarp, in_chunks};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use system::RadialSolver;

/// Number of points per parallel work item (resource limit: hides the scheduling overhead).
const CHUNK: usize = 1024;

/// Plane warp controlled by point pairs, with radial basis functions.
///
/// ```
/// use morphospace::correspondence::PointPair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{PlaneWarp, ScatteredOptions, ScatteredWarp};
///
/// let frame = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
/// let pair = PointPair { source: DVec2::ZERO, target: DVec2::X };
/// let mut warp = ScatteredWarp::new(&frame, &[pair], &[], ScatteredOptions::default())?;
/// let (mut source, mut target) = ([DVec2::ZERO], [DVec2::ZERO]);
/// warp.look_up(0.25, &[DVec2::ONE], &mut source, &mut target);
/// assert_eq!(source, [DVec2::new(0.75, 1.0)]);
/// assert_eq!(target, [DVec2::new(1.75, 1.0)]);
/// # Ok::<(), morphospace::warp::ScatteredError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScatteredWarp {
    features: WarpFeatures,
    solver: RadialSolver,
}

impl ScatteredWarp {
    /// Creates a warp from point pairs and line pairs in frame coordinates.
    ///
    /// Each line is sampled at [`super::LINE_SAMPLES`] points.
    ///
    /// # Errors
    /// [`ScatteredError`] if a coordinate is not finite, an option is out of range, or there are
    /// more than [`super::MAX_FEATURES`] features.
    pub fn new(
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
        options: ScatteredOptions,
    ) -> Result<Self, ScatteredError> {
        options.check()?;
        let features = WarpFeatures::new(frame, points, lines)?;
        let solver = RadialSolver::new(options, features.unit);
        Ok(Self { features, solver })
    }
}

impl PlaneWarp for ScatteredWarp {
    fn look_up(
        &mut self,
        t: f64,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        self.solver.solve(self.features.at(t));
        let (sum, arch) = (&self.solver.sum, self.solver.arch);
        in_chunks(CHUNK, frame, [in_source, in_target], |places, looks| {
            sum.evaluate(arch, places, looks);
        });
    }
}
