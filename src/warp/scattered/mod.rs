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
//! way to each other without a jump (`ease`). Swapping the designs plays the
//! film backwards. No feature is the identity, one a translation, two a
//! similarity.
//! Not guaranteed: that the plane does not fold; see [`super::Lattice`] for
//! that.
//!
//! - `features`: points, and points on lines
//! - `ease`: features that meet
//! - `system`: what is solved, and what is done where it is singular
//! - `kernel`: the functions, many distances at a time
//! - `radial`: the map alone, for other uses

mod ease;
mod features;
mod kernel;
mod radial;
mod system;

#[cfg(test)]
mod tests;

pub(in crate::warp) use features::Features;
pub use features::{FeatureError, LINE_SAMPLES, MAX_FEATURES};
pub use radial::RadialMap;

use super::PlaneWarp;
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use crate::names::named;
use radial::CHUNK;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use system::Solver;

/// The radial function φ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Basis {
    /// r² log r: bends least; moves the whole plane.
    #[default]
    ThinPlate,
    /// exp(−(r / width)²): moves what is near.
    Gaussian,
    /// (r² + rᵢ²)^μ with rᵢ the distance from centre i to its nearest other
    /// (Ruprecht, Müller 1995): tight where features are dense.
    Multiquadric,
}

named! { Basis {
    ThinPlate: "thin-plate", "Thin plate", "Bends least; moves the whole plane.";
    Gaussian: "gaussian", "Gaussian", "Moves what is near a pin.";
    Multiquadric: "multiquadric", "Multiquadric",
        "Tight where pins are dense, wide where they are sparse.";
} }

/// Options of the warp by scattered points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ScatteredOptions {
    /// Which function.
    pub basis: Basis,
    /// The Gaussian's radius as a fraction of the frame's diameter, above 0
    /// and at most 10. Far wider than the features are apart, it costs
    /// digits.
    pub width: f64,
    /// μ of the multiquadric, from −1 to below 1 and not 0; ½ is Ruprecht and
    /// Müller's.
    pub exponent: f64,
    /// λ, at least 0: how much features may be missed for a smoother map, in
    /// units of the frame's diameter. For thin plates λ times the diameter
    /// squared is SciPy's `smoothing`; 0.001 is little and 0.1 much.
    pub smoothing: f64,
}

impl Default for ScatteredOptions {
    /// Thin plates without smoothing.
    fn default() -> Self {
        Self {
            basis: Basis::ThinPlate,
            width: 0.1,
            exponent: 0.5,
            smoothing: 0.0,
        }
    }
}

/// Why a warp by scattered points, or a radial map, is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ScatteredError {
    /// The features cannot be moved by.
    #[error(transparent)]
    Features(#[from] FeatureError),
    /// The Gaussian's radius is out of range.
    #[error("the width is {0}: it must be above 0 and at most 10 of the frame's diameters")]
    Width(f64),
    /// μ is out of range.
    #[error("the exponent is {0}: it must be at least -1, below 1 and not 0; 0.5 is usual")]
    Exponent(f64),
    /// λ is out of range.
    #[error("the smoothing is {0}: it must be at least 0 and finite; 0 meets every feature")]
    Smoothing(f64),
    /// The unit of a radial map is no length.
    #[error("the unit is {0}: it must be a length above 0")]
    Unit(f64),
    /// A centre of a radial map, or its value, is not finite.
    #[error("centre {0} or its value is not finite")]
    Centre(usize),
    /// Centres and values of a radial map do not pair up.
    #[error("{centres} centres and {values} values: give one value for each centre")]
    Lengths {
        /// How many centres.
        centres: usize,
        /// How many values.
        values: usize,
    },
}

impl ScatteredOptions {
    /// That all numbers are in range.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn check(&self) -> Result<(), ScatteredError> {
        if !(self.width > 0.0 && self.width <= 10.0) {
            return Err(ScatteredError::Width(self.width));
        }
        if !((-1.0..1.0).contains(&self.exponent) && self.exponent != 0.0) {
            return Err(ScatteredError::Exponent(self.exponent));
        }
        if !(self.smoothing >= 0.0 && self.smoothing.is_finite()) {
            return Err(ScatteredError::Smoothing(self.smoothing));
        }
        Ok(())
    }
}

/// The row *scattered points*.
///
/// ```
/// use morphospace::correspondence::PointPair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{PlaneWarp, Scattered, ScatteredOptions};
///
/// let frame = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
/// let pair = PointPair { source: DVec2::ZERO, target: DVec2::X };
/// let warp = Scattered::new(&frame, &[pair], &[], ScatteredOptions::default())?;
/// let (mut source, mut target) = ([DVec2::ZERO], [DVec2::ZERO]);
/// warp.look_up(0.25, &mut warp.maps(), &[DVec2::ONE], &mut source, &mut target);
/// assert_eq!(source, [DVec2::new(0.75, 1.0)]);
/// assert_eq!(target, [DVec2::new(1.75, 1.0)]);
/// # Ok::<(), morphospace::warp::ScatteredError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scattered {
    features: Features,
    options: ScatteredOptions,
}

impl Scattered {
    /// A warp by pairs of points, and by lines as [`LINE_SAMPLES`] points
    /// each, in the coordinates of the frame.
    ///
    /// # Errors
    /// [`ScatteredError`] on coordinates that are not finite, on options out
    /// of range and on more than [`MAX_FEATURES`].
    pub fn new(
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
        options: ScatteredOptions,
    ) -> Result<Self, ScatteredError> {
        options.check()?;
        let features = Features::new(frame, points, lines)?;
        Ok(Self { features, options })
    }

    /// What it was built with.
    #[must_use]
    pub fn options(&self) -> &ScatteredOptions {
        &self.options
    }
}

/// The memory of one player of a [`Scattered`].
#[derive(Debug)]
pub struct ScatteredMaps {
    /// Features at t, and from there to source and target.
    at: Vec<DVec2>,
    looks: Vec<[DVec2; 2]>,
    solver: Solver<2>,
}

impl PlaneWarp for Scattered {
    type Maps = ScatteredMaps;

    fn maps(&self) -> ScatteredMaps {
        let room = self.features.len();
        ScatteredMaps {
            at: Vec::with_capacity(room),
            looks: Vec::with_capacity(room),
            solver: Solver::new(self.options, self.features.unit, ease::STEEPEST),
        }
    }

    fn look_up(
        &self,
        t: f64,
        maps: &mut ScatteredMaps,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        let ScatteredMaps { at, looks, solver } = maps;
        at.clear();
        looks.clear();
        for (place, look) in self.features.at(t) {
            at.push(place);
            looks.push(look);
        }
        solver.solve(at, looks);
        let (sum, arch) = (&solver.sum, solver.arch());
        let sources = in_source.par_chunks_mut(CHUNK);
        let looked_up = sources.zip(in_target.par_chunks_mut(CHUNK));
        let chunks = frame.par_chunks(CHUNK).zip(looked_up);
        chunks.for_each(|(places, (source, target))| {
            sum.evaluate(arch, places, true, [source, target]);
        });
    }
}
