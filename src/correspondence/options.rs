//! Options for matching one pair of boundaries, and the errors of such a match.

use super::curve::{BoundaryCurve, CurveLengthError};
use super::pins::PinError;
use serde::{Deserialize, Serialize};

/// Options for matching one pair of boundary curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MatchOptions {
    /// Number of samples along each curve, in 8..=1000; corners and pins are added to these. The
    /// time to match n samples grows as n² log n.
    pub samples: u32,
    /// Whether "up" stays up: directions are compared as drawn instead of up to a rotation.
    pub keep_up: bool,
    /// Weight of stretching (differing arc lengths) relative to bending (differing outlines), at
    /// least 0; 0.25 by default.
    pub stretch: f64,
    /// Weight of differences in thickness between the shapes, at least 0; 1 by default.
    pub thickness: f64,
    /// Weight of differences in inner distances (lengths of shortest paths inside the shape), at
    /// least 0. With 0, the default, only the boundaries are compared. With a positive weight, no
    /// rotation is searched for.
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

/// Reason why two curves cannot be matched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatchError {
    /// The length of a curve overflows or underflows.
    #[error(transparent)]
    Curve(#[from] CurveLengthError),
    /// The pins contradict each other.
    #[error(transparent)]
    Pins(#[from] PinError),
    /// One curve runs counter-clockwise and the other clockwise.
    #[error("the outlines run in opposite directions; reverse the points of one of them")]
    Orientation,
    /// The number of samples is out of range.
    #[error("cannot match with {0} samples; choose a number from 8 to 1000")]
    Samples(u32),
    /// The weight of stretch is negative or not finite.
    #[error("the stretch weight {0} is not valid; choose a number of at least 0, such as 0.25")]
    Stretch(f64),
    /// The weight of differing thickness is negative or not finite.
    #[error("the thickness weight {0} is not valid; choose a number of at least 0, such as 1")]
    Thickness(f64),
    /// The weight of differing inner distances is negative or not finite.
    #[error("the inner-distance weight {0} is not valid; choose a number of at least 0, such as 8")]
    Inner(f64),
}

/// Checks the orientations of two curves and the ranges of the options, but not the pins.
///
/// # Errors
/// [`MatchError`] for opposite orientations or an option out of range.
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
