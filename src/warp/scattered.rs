//! Warps by scattered points: radial basis functions.
//!
//! Ruprecht, Müller, "Image warping with scattered data interpolation" (1995);
//! thin plates: Duchon (1977), Bookstein, "Principal warps" (1989). At t the
//! features lie on the straight lines (1−t) p + t q. From there, two maps
//! lead to the source and to the target: each an identity, plus an affine
//! part, plus Σ cᵢ φ(|x − xᵢ|), that takes every feature to its place. Both
//! have the same centres, so that a frame is one factorisation.
//!
//! Guaranteed: a frame cannot fail. At t = 0 the source, and at t = 1 the
//! target, is looked up at the very same place, to the last bit. Without
//! smoothing, features are met, but for those that the plane would have to be
//! more than twenty times as steep for: features that meet on their way give
//! way to each other without a jump (`places`). Swapping the designs plays the
//! film backwards. No feature is the identity, one a translation, two a
//! similarity.
//! Not guaranteed: that the plane does not fold; see [`super::Lattice`] for
//! that.
//!
//! - `options`: the functions to choose from, and what may be wrong
//! - `places`: where the features are, made ready, and those that meet
//! - `system`: what is solved, and what is done where that is singular
//! - `kernel`: the functions, many distances at a time

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

/// How many places a core takes at a time.
const CHUNK: usize = 1024;

/// The row *scattered points*.
///
/// ```
/// use morphospace::correspondence::PointPair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{PlaneWarp, Scattered, ScatteredOptions};
///
/// let frame = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
/// let pair = PointPair { source: DVec2::ZERO, target: DVec2::X };
/// let mut warp = Scattered::new(&frame, &[pair], &[], ScatteredOptions::default())?;
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
    /// A warp by pairs of points, and by lines as [`super::LINE_SAMPLES`] points
    /// each, in the coordinates of the frame.
    ///
    /// # Errors
    /// [`ScatteredError`] on coordinates that are not finite, on options out
    /// of range and on more than [`super::MAX_FEATURES`].
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
