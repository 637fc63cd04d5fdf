//! The choice of the function and its numbers, and what may be wrong with
//! them.

use crate::settings::choice::named;
use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// The radial function φ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RadialBasis {
    /// r² log r: bends least; moves the whole plane.
    #[default]
    ThinPlate,
    /// exp(−(r / width)²): moves what is near.
    Gaussian,
    /// (r² + rᵢ²)^μ with rᵢ the distance from centre i to its nearest other
    /// (Ruprecht, Müller 1995): tight where features are dense.
    Multiquadric,
}

named! { RadialBasis {
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
    pub basis: RadialBasis,
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
            basis: RadialBasis::ThinPlate,
            width: 0.1,
            exponent: 0.5,
            smoothing: 0.0,
        }
    }
}

/// Why a warp by scattered points is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
