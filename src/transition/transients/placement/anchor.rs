//! Motion of a point that belongs to no outline, derived from the outlines around it.

use crate::geometry::{DVec2, SimilarityFit, signed_area};
use crate::transition::transients::layered_outline::LayeredOutline;

/// Moves the point `here` with the innermost outline that encloses it, from its position in `now`
/// to its position in `then`. Returns the area of that outline and the new position; `None` if no
/// outline encloses the point.
pub(super) fn carried_within(
    here: DVec2,
    now: &[LayeredOutline],
    then: &[LayeredOutline],
) -> Option<(f64, DVec2)> {
    let (size, now, then) = now
        .iter()
        .zip(then)
        .filter(|(now, _)| now.winding(here) != 0)
        .map(|(now, then)| (signed_area(&now.points).abs(), now, then))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    // The fit fails if all points of the outline coincide. The point then stays in place.
    let place = SimilarityFit::of(&now.points, &then.points).map_or(here, |fit| fit.apply(here));
    Some((size, place))
}

/// Moves the point `here`, which no outline encloses, with the outlines around it, from `now` to
/// `then`.
pub(super) fn carried_among(here: DVec2, now: &[LayeredOutline], then: &[LayeredOutline]) -> DVec2 {
    let both = now.iter().zip(then);
    // Interpolation with inverse distance weights (Shepard 1968), to the fourth power, so that near
    // points dominate.
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for (now, then) in both {
        for (p, q) in now.points.iter().zip(&then.points) {
            let weight = p
                .distance_squared(here)
                .powi(2)
                .max(f64::MIN_POSITIVE)
                .recip();
            sum += weight * (*q - *p);
            total += weight;
        }
    }
    if total > 0.0 {
        here + sum / total
    } else {
        here
    }
}
