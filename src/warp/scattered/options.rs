//! Options of the scattered-point warp: the radial function, its parameters and their validation.

use crate::settings::named;
use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// Radial basis function φ(r), where r is the distance of a point from a centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RadialBasis {
    /// r² log r: minimal bending energy, global influence.
    #[default]
    ThinPlate,
    /// exp(−(r / width)²): local influence.
    Gaussian,
    /// (r² + rᵢ²)^μ with rᵢ the distance from centre i to its nearest neighbour (Ruprecht, Müller
    /// 1995): narrow where features are dense.
    Multiquadric,
}

named! { RadialBasis {
    ThinPlate: "thin-plate", "Thin plate",
        "Smoothest interpolation; each pin affects the whole plane.";
    Gaussian: "gaussian", "Gaussian", "Each pin affects only its neighbourhood.";
    Multiquadric: "multiquadric", "Multiquadric",
        "Influence is narrow where pins are dense and wide where they are sparse.";
} }

/// Options of the scattered-point warp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ScatteredOptions {
    /// Radial basis function φ.
    pub basis: RadialBasis,
    /// Radius of the Gaussian as a fraction of the frame's diameter, in (0, 10]. Accuracy drops if
    /// the radius is much larger than the distances between features.
    pub width: f64,
    /// Exponent μ of the multiquadric, from −1 to below 1 but not 0; Ruprecht and Müller use ½.
    pub exponent: f64,
    /// Smoothing parameter λ ≥ 0, which trades accuracy at the features for a smoother mapping. It
    /// is relative to the frame's diameter: for thin plates, λ times the squared diameter equals
    /// SciPy's `smoothing`. 0.001 has a slight and 0.1 a strong effect.
    pub smoothing: f64,
}

impl Default for ScatteredOptions {
    /// Returns thin plates without smoothing.
    fn default() -> Self {
        Self {
            basis: RadialBasis::ThinPlate,
            width: 0.1,
            exponent: 0.5,
            smoothing: 0.0,
        }
    }
}

/// Reason why the scattered-point warp cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScatteredError {
    /// The features are invalid.
    #[error(transparent)]
    Features(#[from] FeatureError),
    /// The Gaussian's radius is outside (0, 10].
    #[error("the width is {0}, but must be above 0 and at most 10 frame diameters")]
    Width(f64),
    /// The exponent μ is 0 or outside [−1, 1).
    #[error("the exponent is {0}, but must be in [-1, 1) and not 0; the default is 0.5")]
    Exponent(f64),
    /// The smoothing parameter λ is negative or not finite.
    #[error("the smoothing is {0}, but must be at least 0 and finite; 0 follows every pin exactly")]
    Smoothing(f64),
}

impl ScatteredOptions {
    /// Checks that all parameters are in range.
    ///
    /// # Errors
    /// [`ScatteredError`] for the first parameter out of range.
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
