//! Options of the line warp and their validation.
//!
//! The weights of the lines depend on the constants a, b and p of Beier, Neely (1992), §3.2. With a
//! near 0, points on a line follow the line exactly; a larger a gives a smoother mapping. With a
//! large b, each point follows its nearest line. With p = 0 all lines weigh the same, with p = 1
//! long lines outweigh short ones. The paper recommends b in [0.5, 2] and p in [0, 1].

use crate::settings::named;
use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// Largest permitted exponent b (derived: the weights at the nearest and at the farthest
/// distinguishable point are still normal numbers).
const MAX_FALLOFF: f64 = 8.0;

/// Interpolation of a line between the designs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LineInterpolation {
    /// Both ends move on straight lines. A line that rotates by π shrinks to a point halfway.
    Ends,
    /// Midpoint and length are interpolated linearly and the direction rotates by the smaller
    /// angle. A line that rotates keeps its length.
    #[default]
    MiddleAndAngle,
}

named! { LineInterpolation {
    MiddleAndAngle: "middle-and-angle", "Rotate",
        "The midpoint moves straight and the direction rotates by the smaller angle";
    Ends: "ends", "Ends", "Both ends move straight; a line that rotates shrinks in between";
} }

/// Options of the line warp.
///
/// ```
/// use morphospace::warp::LineOptions;
/// let options = LineOptions::default();
/// assert_eq!((options.falloff, options.length_exponent), (2.0, 0.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LineOptions {
    /// Constant a > 0 of Beier and Neely, as a fraction of the frame's diameter. Points closer to a
    /// line than this mainly follow that line.
    pub smoothness: f64,
    /// Exponent b in (0, 8] with which the weight of a line falls off with distance.
    pub falloff: f64,
    /// Exponent p ≥ 0 of a line's length in its weight; 0 ignores the length.
    pub length_exponent: f64,
    /// Interpolation of a line between its positions in the designs.
    pub between: LineInterpolation,
}

impl Default for LineOptions {
    fn default() -> Self {
        Self {
            smoothness: 0.01,
            falloff: 2.0,
            length_exponent: 0.5,
            between: LineInterpolation::default(),
        }
    }
}

/// Reason why the line warp cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinesError {
    /// The constant a, `smoothness`, is not a positive finite number.
    #[error("the smoothness of the lines is {0}, but must be above 0; the default is 0.01")]
    Smoothness(f64),
    /// The exponent b, `falloff`, is out of range.
    #[error("the falloff of the lines is {0}, but must be above 0 and at most 8; the default is 2")]
    Falloff(f64),
    /// The exponent p, `length_exponent`, is negative or not finite.
    #[error("the length exponent of the lines is {0}, but must be at least 0; the default is 0.5")]
    LengthExponent(f64),
    /// The features are invalid.
    #[error(transparent)]
    Features(#[from] FeatureError),
}

/// Validated constants a, b and p of Beier and Neely; a is a length in plane units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BeierNeelyConstants {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) p: f64,
}

impl LineOptions {
    /// Validates the constants and converts a to a length in a frame with the given diameter.
    pub(super) fn constants(&self, diameter: f64) -> Result<BeierNeelyConstants, LinesError> {
        let (a, b, p) = (self.smoothness, self.falloff, self.length_exponent);
        if !(a > 0.0 && a.is_finite()) {
            return Err(LinesError::Smoothness(a));
        }
        if !(b > 0.0 && b <= MAX_FALLOFF) {
            return Err(LinesError::Falloff(b));
        }
        if !(p >= 0.0 && p.is_finite()) {
            return Err(LinesError::LengthExponent(p));
        }
        let a = (a * diameter).clamp(f64::MIN_POSITIVE, f64::MAX);
        Ok(BeierNeelyConstants { a, b, p })
    }
}
