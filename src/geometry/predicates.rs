//! Orientation of three points with an exact sign (Shewchuk 1997, through the `robust` crate) or in
//! plain floating point, and a total order on lists of numbers.

use super::DVec2;
use std::cmp::Ordering;

/// Returns twice the signed area of the triangle `abc`: positive if it runs counter-clockwise, zero
/// exactly if the points are collinear. The sign is exact as long as no product of differences
/// over- or underflows; the value is rounded.
///
/// ```
/// use morphospace::geometry::{DVec2, orient2d};
/// assert!(orient2d(DVec2::ZERO, DVec2::X, DVec2::Y) > 0.0);
/// ```
#[must_use]
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Returns twice the signed area of the triangle `abc` in plain floating point. It is faster than
/// [`orient2d`], but its sign is unreliable near zero.
#[must_use]
pub fn twice_signed_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Compares two lists by the first pair of numbers that differ. This is a total order on lists of
/// equal length.
pub(crate) fn lexicographic(
    a: impl IntoIterator<Item = f64>,
    b: impl IntoIterator<Item = f64>,
) -> Ordering {
    let mut orders = a.into_iter().zip(b).map(|(a, b)| a.total_cmp(&b));
    let different = orders.find(|order| order.is_ne());
    different.unwrap_or(Ordering::Equal)
}
