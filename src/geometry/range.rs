//! Limits on coordinates, on the size of a design and on its distance from the origin. They are the
//! same for all formats and are checked where regions, meshes and trusses are created.
//!
//! Within these limits squares, areas, products of four lengths and their sums are finite and
//! non-zero in `f64`, and squares are in the `f32` of a graphics card. The libraries need less:
//! `i_overlay` at most 2⁵⁰⁰, `spade` 2⁻¹⁴² to 2²⁰¹.

use super::{Bounds, DVec2};
use std::fmt;

/// Largest absolute value of a coordinate (derived: the square of a distance is then at most 8 ×
/// 10³⁶, and `f32` ends at 3 × 10³⁸).
pub const MAX_COORDINATE: f64 = 1e18;

/// Smallest longer side of a design (derived in the same way).
pub const MIN_SIZE: f64 = 1e-18;

/// Message about a point that is not [`is_in_range`], without its subject.
pub(crate) const RANGE_MESSAGE: &str =
    "has a coordinate that is not a number between -1e18 and 1e18; correct it, or scale the design";

/// Maximum distance of a design from the origin, in multiples of its longer side (derived: some
/// thousand distinct numbers are left along the design there, as many as a match puts points on an
/// outline).
const MAX_DISTANCE: f64 = 1e12;

/// Reason why a design's size or place is out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignSizeError {
    /// All points coincide, or nearly.
    #[error("the design is only {0:e} wide, less than the minimum of {MIN_SIZE:e}; scale it up")]
    TooSmall(f64),
    /// The points are too far from the origin for their distances from each other.
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
    /// Checks a bounding box and returns its longer side.
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

/// Point as shown in messages, with four digits at any size.
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
