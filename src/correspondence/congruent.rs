//! Refines the match of two curves that a similarity maps almost onto each other, to an accuracy of
//! a fraction of the sample spacing.
//!
//! A path through sample pairs is only as accurate as the sample spacing, and on smooth sections
//! only the stretching cost determines the path. For two versions of one design (traced again,
//! simplified, or with other vertices) a better match exists: the similarity that best fits the
//! given match maps one curve onto the other, and each point is matched with the point on which it
//! lands. This is the iterated closest point method (Besl, McKay 1992), restricted to the
//! neighbourhood of the given match.

use super::curve::BoundaryCurve;
use super::knot_order::{is_pin, ordered_knots};
use crate::geometry::{DVec2, SimilarityFit};

/// Maximum root mean square distance between matched points after the best-fitting similarity, as a
/// fraction of the target's length. Two curves with a larger distance do not count as nearly
/// congruent (heuristic).
const MAX_RESIDUAL: f64 = 0.012;

/// Maximum distance along the target by which a knot may move from its original place, as a
/// fraction of the target's length (heuristic).
const MAX_SHIFT: f64 = 0.025;
/// Maximum distance at which a transformed source point is matched with its nearest target point,
/// as a fraction of the target's length (heuristic).
const MAX_DISTANCE: f64 = 0.01;

/// Maximum number of iterations of the iterated closest point method (resource limit).
const MAX_ROUNDS: usize = 8;

/// Half-length of the section of a curve over which its direction is averaged, as a fraction of the
/// curve's length (heuristic).
const TANGENT_REACH: f64 = 0.005;
/// Minimum cosine of the angle between the curves' directions at two matched points: the angle is
/// at most 60° (heuristic).
const SAME_DIRECTION: f64 = 0.5;

/// Minimum shift of a knot, as a fraction of the target's length. A knot with a smaller shift keeps
/// its exact place, so that corners stay on corners (tolerance: above rounding).
const MIN_SHIFT: f64 = 1e-9;

/// Maps the source point of each knot by the best-fitting similarity, and moves the knot's target
/// place to the point of the target that is nearest to the mapped point. A knot without such a
/// point nearby keeps its place; pins do not move. `knots` ascend in the source.
///
/// Moved knots that break the cyclic order are omitted. Returns `None` if at least half of the
/// knots are omitted, or if no similarity maps the curves almost onto each other.
pub(super) fn registered_knots(
    knots: &[[f64; 2]],
    pins: &[[f64; 2]],
    [source, target]: [&BoundaryCurve; 2],
) -> Option<Vec<[f64; 2]>> {
    let length = target.length();
    let mut places: Vec<f64> = knots.iter().map(|k| k[1]).collect();
    let is_fixed = |k: usize| is_pin(pins, knots[k]);
    let points: Vec<DVec2> = knots.iter().map(|k| source.point_at(k[0])).collect();
    for round in 0..MAX_ROUNDS {
        let landed: Vec<DVec2> = places
            .iter()
            .map(|&nearest| target.point_at(nearest))
            .collect();
        let fit = SimilarityFit::of(&points, &landed)?;
        // Check the residual in the first round of the loop only, because later rounds reduce it
        // for any two curves.
        if round == 0 && fit.residual(&points, &landed) > MAX_RESIDUAL * length {
            return None;
        }
        let mut max_move: f64 = 0.0;
        for (k, place) in places.iter_mut().enumerate() {
            if is_fixed(k) {
                continue;
            }
            let [from, matched] = knots[k];
            let p = fit.apply(points[k]);
            let is_same_way = |place: f64| {
                let own = source.direction(from - TANGENT_REACH, from + TANGENT_REACH);
                let other = target.direction(place - TANGENT_REACH, place + TANGENT_REACH);
                (own + fit.angle() - other).cos() > SAME_DIRECTION
            };
            // In each round of the loop, search around the originally matched place, so that the
            // knot cannot drift away.
            let (low, high) = (matched - MAX_SHIFT, matched + MAX_SHIFT);
            let (nearest, distance) = target.nearest_within(p, low, high);
            let lands = distance <= MAX_DISTANCE * length && is_same_way(nearest);
            let next = if lands && (nearest - matched).abs() > MIN_SHIFT {
                nearest
            } else {
                matched
            };
            max_move = max_move.max(target.point_at(next).distance(target.point_at(*place)));
            *place = next;
        }
        // Converged: no knot moves visibly any more.
        if max_move < 1e-6 * length {
            break;
        }
    }
    let registered: Vec<[f64; 2]> = knots.iter().zip(places).map(|(k, b)| [k[0], b]).collect();
    let monotone = ordered_knots(knots, &registered, pins);
    // The refinement has failed if half of the knots or more break monotonicity.
    (2 * monotone.len() > knots.len()).then_some(monotone)
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
    fn dissimilar_curves_are_not_registered() {
        let square = closed(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let bar = closed(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]);
        let knots = [0.0, 0.25, 0.5, 0.75].map(|place| [place, place]);
        assert_eq!(registered_knots(&knots, &[], [&square, &bar]), None);
    }

    #[test]
    fn slightly_shifted_knots_are_corrected() {
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
