//! Where a place goes that nothing lies at, by what lies around it.

use crate::geometry::{DVec2, Fit, signed_area};
use crate::transition::outline::Outline;

/// Where outlines, as they are and as they are then, take a place.
pub(super) fn carried_among(here: DVec2, now: &[Outline], then: &[Outline]) -> DVec2 {
    let both = || now.iter().zip(then);
    let around = both().filter(|(now, _)| now.winding(here) != 0);
    let size = |outline: &Outline| signed_area(&outline.points).abs();
    let innermost = around.min_by(|a, b| size(a.0).total_cmp(&size(b.0)));
    if let Some((now, then)) = innermost {
        // A ring of one point has no turn.
        return Fit::of(&now.points, &then.points).map_or(here, |fit| fit.apply(here));
    }
    // Shepard 1968, near neighbours counting most.
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for (now, then) in both() {
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
