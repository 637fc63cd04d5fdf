//! Limits on coordinates, on the size of a design and on its distance from the origin. They are the
//! same for all formats and are checked where regions, meshes and trusses are created.
//!
//! Within these limits, areas, squares of lengths, products of four lengths and their sums neither
//! overflow nor underflow in `f64`. In the `f32` of a graphics card, this holds for squares of
//! lengths. The limits of the libraries are wider: `i_overlay` allows coordinates up to 2⁵⁰⁰, and
//! `spade` from 2⁻¹⁴² to 2²⁰¹.

use super::{Bounds, DVec2};
use std::fmt;

/// Largest absolute value of a coordinate (derived: the square of a distance is then at most 8 ×
/// 10³⁶, and `f32` ends at 3 × 10³⁸).
pub const MAX_COORDINATE: f64 = 1e18;

/// Minimum length of the longer side of a design (derived: its square is then 10⁻³⁶, and full
/// precision in `f32` begins at 10⁻³⁸).
pub const MIN_SIZE: f64 = 1e-18;

/// End of the error message about a point for which [`is_in_range`] is false. The caller puts the
/// name of the point in front, as the subject of the sentence.
pub(crate) const RANGE_MESSAGE: &str =
    "has a coordinate that is not a number between -1e18 and 1e18; correct it, or scale the design";

/// Maximum distance of a design from the origin, in multiples of the design's longer side (derived:
/// at that distance a few thousand distinct coordinates remain along the design, about as many as a
/// match puts points on an outline).
const MAX_DISTANCE: f64 = 1e12;

/// Reason why the size or the position of a design is out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignSizeError {
    /// All points coincide, or nearly. The number is the longer side of the design.
    #[error("the design is only {0:e} wide, less than the minimum of {MIN_SIZE:e}; scale it up")]
    TooSmall(f64),
    /// The design is too far from the origin for its size, so rounding would distort it.
    #[error(
        "the design is {size:e} wide but lies {away:e} away from the origin, where numbers are too coarse for it; move it to the origin"
    )]
    TooFar {
        /// Longer side of the design.
        size: f64,
        /// Largest absolute value of a coordinate.
        away: f64,
    },
}

impl DesignSizeError {
    /// Checks the bounding box of a design, and returns its longer side.
    pub(crate) fn check(bounds: &Bounds) -> Result<f64, Self> {
        let size = bounds.size().max_element();
        let away = bounds.min.abs().max(bounds.max.abs()).max_element();
        match size {
            _ if size < MIN_SIZE => Err(Self::TooSmall(size)),
            _ if size * MAX_DISTANCE < away => Err(Self::TooFar { size, away }),
            _ => Ok(size),
        }
    }
}

/// Returns whether both coordinates are numbers of absolute value at most [`MAX_COORDINATE`].
#[must_use]
pub fn is_in_range(p: DVec2) -> bool {
    // Comparisons with NaN are false.
    p.abs().cmple(DVec2::splat(MAX_COORDINATE)).all()
}

/// Point as shown in messages, with four significant digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproxPoint(pub DVec2);

impl fmt::Display for ApproxPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = |x: f64| format!("{x:.3e}").parse().unwrap_or(x);
        write!(f, "near ({}, {})", rounded(self.0.x), rounded(self.0.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_shown_with_four_digits() {
        for (x, y, text) in [
            (0.1 + 0.2, -0.0, "near (0.3, -0)"),
            (1.0 / 3.0, 1234.56, "near (0.3333, 1235)"),
            (1e15, -2.5e-7, "near (1000000000000000, -0.00000025)"),
        ] {
            assert_eq!(ApproxPoint(DVec2::new(x, y)).to_string(), text);
        }
    }
}
