//! How boundaries are matched, and why they cannot be.

use super::curve::{BoundaryCurve, CurveLengthError};
use super::pins::PinError;
use serde::{Deserialize, Serialize};

/// How boundaries are matched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MatchOptions {
    /// Samples along each curve, in 8..=1000; corners and pins come on top.
    /// Cost grows as n² log n.
    pub samples: u32,
    /// Keep "up": compare directions as drawn instead of up to a rotation.
    pub keep_up: bool,
    /// Price of stretch against bending, at least 0; 0.25 unless stated.
    pub stretch: f64,
    /// Price of differing thickness, at least 0; 1 unless stated.
    pub thickness: f64,
    /// Price of differing inner distances, at least 0; 0 unless stated, and
    /// then the boundary alone is compared. With a price no pose is guessed.
    pub inner: f64,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self {
            samples: 160,
            keep_up: false,
            stretch: 0.25,
            thickness: 1.0,
            inner: 0.0,
        }
    }
}

/// Why two curves cannot be matched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatchError {
    /// A curve has no usable length.
    #[error(transparent)]
    Curve(#[from] CurveLengthError),
    /// The pins contradict each other.
    #[error(transparent)]
    Pins(#[from] PinError),
    /// One curve runs counter-clockwise and the other clockwise.
    #[error("the outlines run opposite ways around; reverse the points of one of them")]
    Orientation,
    /// The number of samples is out of range.
    #[error("{0} samples cannot be matched; choose a number from 8 to 1000")]
    Samples(u32),
    /// The price of stretch is negative or not finite.
    #[error("the price of stretch {0} is not a number of at least 0; choose one such as 0.25")]
    Stretch(f64),
    /// The price of differing thickness is negative or not finite.
    #[error("the price of thickness {0} is not a number of at least 0; choose one such as 1")]
    Thickness(f64),
    /// The price of inner distances is negative or not finite.
    #[error("the price of inner distances {0} is not a number of at least 0; choose one such as 8")]
    Inner(f64),
}

/// Whether two curves can be matched at all, pins aside.
pub(super) fn check(
    source: &BoundaryCurve,
    target: &BoundaryCurve,
    options: &MatchOptions,
) -> Result<(), MatchError> {
    if source.turning_number() * target.turning_number() < 0 {
        return Err(MatchError::Orientation);
    }
    if !(8..=1000).contains(&options.samples) {
        return Err(MatchError::Samples(options.samples));
    }
    if !(options.stretch.is_finite() && options.stretch >= 0.0) {
        return Err(MatchError::Stretch(options.stretch));
    }
    if !(options.thickness.is_finite() && options.thickness >= 0.0) {
        return Err(MatchError::Thickness(options.thickness));
    }
    if !(options.inner.is_finite() && options.inner >= 0.0) {
        return Err(MatchError::Inner(options.inner));
    }
    Ok(())
}
