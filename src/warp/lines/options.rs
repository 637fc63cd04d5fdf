//! The constants of the weights, and what may be wrong with the input.
//!
//! Beier, Neely (1992), §3.2: with a near 0 lines are followed to the pixel,
//! large ones are smooth; with b large, each place follows its nearest line;
//! with p = 0 all lines are alike, with p = 1 long ones outweigh short ones.
//! The paper's useful ranges are b in [0.5, 2] and p in [0, 1].

use crate::settings::choice::named;
use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// The largest b: weights of the nearest and of the farthest place that can be
/// told apart are then still normal numbers.
const MAX_FALLOFF: f64 = 8.0;

/// How a line at t lies between its two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LineInterpolation {
    /// Both ends move on straight lines. A line that turns by π shrinks to a
    /// point on the way.
    Ends,
    /// Mid-point and length move straight, the direction turns the shorter
    /// way; one that turns by π keeps its length.
    #[default]
    MiddleAndAngle,
}

named! { LineInterpolation {
    MiddleAndAngle: "middle-and-angle", "Turn",
        "Its middle moves straight, its direction turns the shorter way";
    Ends: "ends", "Ends", "Both ends move straight: a line that turns shrinks on the way";
} }

/// How lines move what is around them.
///
/// ```
/// use morphospace::warp::LineOptions;
/// let options = LineOptions::default();
/// assert_eq!((options.falloff, options.length_exponent), (2.0, 0.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LineOptions {
    /// a > 0, as a fraction of the frame's diameter: within this distance of
    /// a line, it is followed.
    pub smoothness: f64,
    /// b in (0, 8]: how fast weight falls with distance.
    pub falloff: f64,
    /// p ≥ 0: how much more long lines weigh.
    pub length_exponent: f64,
    /// How lines lie between their two.
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

/// Why there is no warp by these lines.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinesError {
    /// a is not a positive finite number.
    #[error("the smoothness of the lines is {0}: it must be above 0; 0.01 is usual")]
    Smoothness(f64),
    /// b is out of range.
    #[error("the falloff of the lines is {0}: it must be above 0 and at most 8; 2 is usual")]
    Falloff(f64),
    /// p is not a finite number from 0.
    #[error("the length exponent of the lines is {0}: it must be at least 0; 0.5 is usual")]
    LengthExponent(f64),
    /// The features cannot be moved by.
    #[error(transparent)]
    Features(#[from] FeatureError),
}

/// a, b and p, checked; a in units of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BeierNeelyConstants {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) p: f64,
}

impl LineOptions {
    /// The constants in a frame of this diameter.
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
