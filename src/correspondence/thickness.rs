//! How thick a shape is behind each point of its boundary.
//!
//! The median length of a few rays into the shape, as in Shapira, Shamir and
//! Cohen-Or 2008 (the shape diameter function). A limb keeps its thickness
//! however it is bent, so that it tells where along a tail or an arm a point
//! is, which turning and position cannot.
//!
//! Guaranteed: finite, and the same for the shape moved, turned or enlarged,
//! to rounding. A curve that turns no way around has no inside; its thickness is
//! the same everywhere.

use super::curve::BoundaryCurve;
use crate::geometry::{DVec2, EdgeBvh, signed_area};
use std::f64::consts::FRAC_PI_6;

/// Rays at these multiples of 30° from the inward normal. At a tip those
/// aslant meet its sides, so that the median is the tip's own thickness.
const RAYS: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];

/// Hits nearer than this share of the shape's extent are the point's own edge.
/// Far above the rounding of a place on an edge, far below any thickness.
const OWN: f64 = 1e-7;

/// Logarithm of the thickness at each place, less its mean along the curve.
/// With each place, ascending, comes the mean direction of the boundary there,
/// in radians.
pub(super) fn log_thickness(curve: &BoundaryCurve, places: &[(f64, f64)]) -> Vec<f64> {
    let turns = curve.turning_number();
    if turns == 0 {
        return vec![0.0; places.len()];
    }
    let points = curve.points();
    let size = signed_area(points).abs().sqrt();
    if !(size.is_finite() && size > 0.0) {
        return vec![0.0; places.len()];
    }
    let side = f64::from(turns.signum());
    let edges = EdgeBvh::of(points);
    let at = |&(place, direction): &(f64, f64)| {
        let from = curve.point_at(place);
        let mut lengths = RAYS.map(|k| {
            let angle = direction + side * 3.0 * FRAC_PI_6 + k * FRAC_PI_6;
            edges.first_beyond(from, DVec2::from_angle(angle), OWN * size)
        });
        lengths.sort_by(f64::total_cmp);
        let median = lengths[RAYS.len() / 2].min(size);
        (median / size).max(OWN).ln()
    };
    centred(places.iter().map(at).collect(), places)
}

/// The values less their mean along the curve: a design with long limbs has a
/// larger area for the same thickness of limbs.
fn centred(mut values: Vec<f64>, places: &[(f64, f64)]) -> Vec<f64> {
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
