//! Predicates that decide topology, with exact signs (Shewchuk 1997, through
//! the `robust` crate), beside the plain floating-point area.

use super::DVec2;
use std::cmp::Ordering;

/// Twice the signed area of `abc`: positive when they turn counter-clockwise,
/// zero exactly when they are collinear. The sign is exact as long as no
/// product of differences over- or underflows; the value is not.
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

/// Twice the signed area of `abc` in plain floating point: faster than
/// [`orient2d`], with a sign that cannot be trusted near zero.
#[must_use]
pub fn twice_signed_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// The order of two lists by the first numbers that differ: a total order of
/// lists of one length.
pub(crate) fn lexicographic(
    a: impl IntoIterator<Item = f64>,
    b: impl IntoIterator<Item = f64>,
) -> Ordering {
    let mut orders = a.into_iter().zip(b).map(|(a, b)| a.total_cmp(&b));
    let different = orders.find(|order| order.is_ne());
    different.unwrap_or(Ordering::Equal)
}
