//! Measures the thickness of a shape at each point of its boundary.
//!
//! The thickness is the median length of a few rays into the shape, as in Shapira, Shamir and
//! Cohen-Or 2008 (the shape diameter function). Bending a limb does not change its thickness.
//! Thickness therefore shows how far along a tail or an arm a point lies, which turning and
//! position cannot show.
//!
//! Guarantees: values are finite and, up to rounding, invariant under translation, rotation and
//! scaling. A curve with turning number 0 has no inside; its thickness is constant.

use super::curve::BoundaryCurve;
use crate::geometry::{DVec2, EdgeBvh, signed_area};
use std::f64::consts::FRAC_PI_6;

/// Directions of the rays, in multiples of 30° from the inward normal. At a tip, the oblique rays
/// hit the sides of the tip, so the median is the thickness of the tip (heuristic).
const RAYS: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];

/// Distance from the start of a ray within which its hits are ignored, because they lie on the edge
/// where the ray starts. It is a fraction of the shape's size, and is also the minimum thickness
/// (tolerance: far above the rounding of a point on an edge, far below any thickness).
const OWN_EDGE: f64 = 1e-7;

/// Returns the logarithm of the thickness at each place, minus its mean along the curve. `places`
/// holds ascending places, each with the mean direction of the boundary there in radians.
pub(super) fn log_thickness(curve: &BoundaryCurve, places: &[(f64, f64)]) -> Vec<f64> {
    let turning_number = curve.turning_number();
    if turning_number == 0 {
        return vec![0.0; places.len()];
    }
    let points = curve.points();
    let size = signed_area(points).abs().sqrt();
    if !(size.is_finite() && size > 0.0) {
        return vec![0.0; places.len()];
    }
    let inward_sign = f64::from(turning_number.signum());
    let edges = EdgeBvh::of(points);
    let log_at = |&(place, direction): &(f64, f64)| {
        let from = curve.point_at(place);
        let mut lengths = RAYS.map(|k| {
            let angle = direction + inward_sign * 3.0 * FRAC_PI_6 + k * FRAC_PI_6;
            edges.first_hit_beyond(from, DVec2::from_angle(angle), OWN_EDGE * size)
        });
        lengths.sort_by(f64::total_cmp);
        let median = lengths[RAYS.len() / 2].min(size);
        (median / size).max(OWN_EDGE).ln()
    };
    subtract_mean(places.iter().map(log_at).collect(), places)
}

/// Subtracts from each logarithm the mean along the curve. Thickness is in units of the square root
/// of the area, so a design with longer limbs of the same thickness, which has a larger area, would
/// otherwise count as thinner.
fn subtract_mean(mut values: Vec<f64>, places: &[(f64, f64)]) -> Vec<f64> {
    let n = values.len();
    let gap = |from: usize, to: usize| (places[to].0 - places[from].0).rem_euclid(1.0);
    let weight = |k: usize| gap((k + n - 1) % n, k) + gap(k, (k + 1) % n);
    let (mut sum, mut total) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        sum += weight(k) * value;
        total += weight(k);
    }
    if total > 0.0 {
        values.iter_mut().for_each(|value| *value -= sum / total);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    #[test]
    fn a_step_in_thickness_is_seen_from_either_side_of_the_boundary() {
        let steps = [
            (0.0, 0.0),
            (20.0, 0.0),
            (20.0, 1.0),
            (10.0, 1.0),
            (10.0, 2.0),
            (0.0, 2.0),
        ];
        for reversed in [false, true] {
            let ring = Ring::new(steps.map(DVec2::from).to_vec()).expect("a ring");
            let ring = if reversed { ring.reversed() } else { ring };
            let curve = BoundaryCurve::closed(&ring).expect("length");
            let direction = if reversed { std::f64::consts::PI } else { 0.0 };
            let mut places = [5.0, 15.0].map(|x| (curve.nearest(DVec2::new(x, 0.0)), direction));
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            let found = log_thickness(&curve, &places);
            assert!(
                ((found[0] - found[1]).abs() - 2f64.ln()).abs() < 1e-9,
                "{found:?}"
            );
            assert!((found[0] + found[1]).abs() < 1e-9, "{found:?}");
        }
    }
}
