//! How large coordinates may be, how small a design, and how far away it may
//! lie: the same for all formats, and checked where regions, meshes and trusses
//! are made.
//!
//! Within these bounds squares, areas, products of four lengths and their
//! sums are finite and not zero in `f64`, and squares in the `f32` of a
//! graphics card. The libraries ask for less: `i_overlay` for 2⁵⁰⁰, `spade`
//! for 2²⁰¹ and no less than 2⁻¹⁴².

use super::{Bounds, DVec2};
use std::fmt;

/// The largest coordinate, either way: the square of a distance is at most
/// 8 × 10³⁶, and `f32` ends at 3 × 10³⁸.
pub const MAX_COORDINATE: f64 = 1e18;

/// The least that the longer side of a design may measure, likewise.
pub const MIN_SIZE: f64 = 1e-18;

/// What is said of a point that is not [`is_in_range`].
pub(crate) const RANGE_MESSAGE: &str =
    "has a coordinate that is no number from -1e18 to 1e18; correct it, or scale the design";

/// How far away from the origin a design may lie, in its longer sides: there
/// some thousand numbers are left along it, as many as a match puts points on
/// an outline. A unit square at 1e15 has nine, and its points became one.
const MAX_DISTANCE: f64 = 1e12;

/// Why a size cannot be reckoned with.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignSizeError {
    /// Points that lie on one another, or as good as.
    #[error(
        "all of it lies within {0:e}, less than the least size of {MIN_SIZE:e}; scale the design up"
    )]
    TooSmall(f64),
    /// Points that are too far away for how near to each other they are.
    #[error(
        "it is {size:e} large and lies {away:e} away from the origin, where numbers are too coarse for that; move the design to the origin"
    )]
    TooFar {
        /// The longer side.
        size: f64,
        /// The largest coordinate.
        away: f64,
    },
}

impl DesignSizeError {
    /// The longer side of what can be reckoned with.
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

/// Whether both coordinates are numbers of at most [`MAX_COORDINATE`].
#[must_use]
pub fn is_in_range(p: DVec2) -> bool {
    // What is no number is less than nothing.
    p.abs().cmple(DVec2::splat(MAX_COORDINATE)).all()
}

/// A place as messages have it: with four digits, at whatever size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproxPoint(pub DVec2);

impl fmt::Display for ApproxPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = |x: f64| format!("{x:.3e}").parse().unwrap_or(x);
        write!(f, "about ({}, {})", rounded(self.0.x), rounded(self.0.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_told_with_four_digits() {
        for (x, y, told) in [
            (0.1 + 0.2, -0.0, "about (0.3, -0)"),
            (1.0 / 3.0, 1234.56, "about (0.3333, 1235)"),
            (1e15, -2.5e-7, "about (1000000000000000, -0.00000025)"),
        ] {
            assert_eq!(ApproxPoint(DVec2::new(x, y)).to_string(), told);
        }
    }
}
