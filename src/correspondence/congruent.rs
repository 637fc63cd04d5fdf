//! Curves that are nearly the same up to a similarity, matched to within a
//! fraction of a sample.
//!
//! A path through pairs of samples is as exact as the samples are close, and
//! where an outline is smooth nothing but the price of stretch holds it. A
//! design against another drawing of itself (traced again, simplified, with
//! other points) can be matched better: the similarity that the match
//! implies lays one upon the other, and each point belongs where it lands.
//! That is the iterated closest point (Besl, McKay 1992), kept near the match
//! that was found.

use super::curve::BoundaryCurve;
use super::knot_order::{is_pin, ordered_knots};
use crate::geometry::{DVec2, SimilarityFit};

/// Curves count as nearly the same where matched points are off by no more
/// than this, as a root of the mean square in lengths of the target.
const ALIKE: f64 = 0.012;

/// So far along the target a knot may be moved, and so near its own point
/// must land for that, in lengths of the target.
const REACH: f64 = 0.025;
const NEAR: f64 = 0.01;

/// How often the curves are laid upon each other.
const ROUNDS: usize = 8;

/// Half the stretch over which directions are compared, in lengths, and the
/// least cosine between directions that are the same.
const TANGENT_REACH: f64 = 0.005;
const SAME_DIRECTION: f64 = 0.5;

/// A knot that moves less keeps its place to the last bit: corner on corner.
const EXACT: f64 = 1e-9;

/// Knots with each source point matched to where it falls on the target,
/// where the curves are nearly the same; none where they are not. `knots` is
/// ascending in the source; pins stay.
pub(super) fn registered_knots(
    knots: &[[f64; 2]],
    pins: &[[f64; 2]],
    [source, target]: [&BoundaryCurve; 2],
) -> Option<Vec<[f64; 2]>> {
    let length = target.length();
    let mut places: Vec<f64> = knots.iter().map(|k| k[1]).collect();
    let is_held = |k: usize| is_pin(pins, knots[k]);
    let points: Vec<DVec2> = knots.iter().map(|k| source.point_at(k[0])).collect();
    for round in 0..ROUNDS {
        let landed: Vec<DVec2> = places.iter().map(|&b| target.point_at(b)).collect();
        let fit = SimilarityFit::of(&points, &landed)?;
        // Later rounds only come nearer.
        if round == 0 && fit.residual(&points, &landed) > ALIKE * length {
            return None;
        }
        let mut moved: f64 = 0.0;
        for (k, place) in places.iter_mut().enumerate() {
            if is_held(k) {
                continue;
            }
            let [from, found] = knots[k];
            let p = fit.apply(points[k]);
            let is_same_way = |b: f64| {
                let own = source.direction(from - TANGENT_REACH, from + TANGENT_REACH);
                let other = target.direction(b - TANGENT_REACH, b + TANGENT_REACH);
                (own + fit.angle() - other).cos() > SAME_DIRECTION
            };
            // About the place that was found, not the last one: it must not creep away.
            let (b, distance) = target.nearest_within(p, found - REACH, found + REACH);
            let lands = distance <= NEAR * length && is_same_way(b);
            let next = if lands && (b - found).abs() > EXACT {
                b
            } else {
                found
            };
            moved = moved.max(target.point_at(next).distance(target.point_at(*place)));
            *place = next;
        }
        if moved < 1e-6 * length {
            break;
        }
    }
    let settled: Vec<[f64; 2]> = knots.iter().zip(places).map(|(k, b)| [k[0], b]).collect();
    let kept = ordered_knots(knots, &settled, pins);
    // What loses many knots did not settle.
    (2 * kept.len() > knots.len()).then_some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    fn closed(points: &[(f64, f64)]) -> BoundaryCurve {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        BoundaryCurve::closed(&Ring::new(points).expect("a ring")).expect("a size")
    }

    #[test]
    fn unlike_curves_are_left_alone() {
        let square = closed(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let bar = closed(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]);
        let knots = [0.0, 0.25, 0.5, 0.75].map(|place| [place, place]);
        assert_eq!(registered_knots(&knots, &[], [&square, &bar]), None);
    }

    #[test]
    fn knots_a_little_off_are_put_right() {
        let shape = closed(&[(0.0, 0.0), (3.0, 0.0), (2.0, 1.0), (0.5, 1.5)]);
        let knots: Vec<_> = (0..40)
            .map(|k| {
                let place = f64::from(k) / 40.0;
                [place, (place + 0.004 * f64::from(k % 3)).rem_euclid(1.0)]
            })
            .collect();
        let found = registered_knots(&knots, &[], [&shape, &shape]).expect("nearly the same");
        assert!(found.len() > 30);
        for [a, b] in found {
            let off = shape.point_at(a).distance(shape.point_at(b));
            assert!(off < 1e-3 * shape.length(), "{a} at {b}: {off}");
        }
    }
}
