//! Where a place goes that nothing lies at, by what lies around it.

use crate::geometry::{DVec2, SimilarityFit, signed_area};
use crate::transition::transients::layered_outline::LayeredOutline;

/// Where the innermost of some outlines that go around a place takes it, from as
/// they are now to as they are then, and what that outline encloses.
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
    // A ring of one point has no turn.
    let place = SimilarityFit::of(&now.points, &then.points).map_or(here, |fit| fit.apply(here));
    Some((size, place))
}

/// Where outlines take a place that lies beside them.
pub(super) fn carried_among(here: DVec2, now: &[LayeredOutline], then: &[LayeredOutline]) -> DVec2 {
    let both = now.iter().zip(then);
    // Shepard 1968, near neighbours counting most.
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
