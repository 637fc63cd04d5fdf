//! Registers curves that are nearly congruent up to a similarity, to within a fraction of a sample.
//!
//! A path through sample pairs is only as accurate as the sample spacing, and on smooth stretches
//! only the weight of stretch determines it. For two versions of one design (traced again,
//! simplified, or with other vertices) a better match exists: the similarity implied by the match
//! lays one curve on the other, and each point belongs where it lands. This is the iterated closest
//! point method (Besl, McKay 1992), restricted to the neighbourhood of the given match.

use super::curve::BoundaryCurve;
use super::knot_order::{is_pin, ordered_knots};
use crate::geometry::{DVec2, SimilarityFit};

/// Maximum root mean square distance of matched points, in lengths of the target, at which curves
/// count as nearly congruent (heuristic).
const MAX_RESIDUAL: f64 = 0.012;

/// Maximum shift of a knot along the target, in lengths of the target (heuristic).
const MAX_SHIFT: f64 = 0.025;
/// Maximum distance of a transformed source point from the target, in lengths of the target
/// (heuristic).
const MAX_DISTANCE: f64 = 0.01;

/// Maximum number of registration rounds (resource limit).
const MAX_ROUNDS: usize = 8;

/// Half-length of the window over which directions are averaged, in fractions of a curve's length
/// (heuristic).
const TANGENT_REACH: f64 = 0.005;
/// Minimum cosine between directions that count as equal: 60° (heuristic).
const SAME_DIRECTION: f64 = 0.5;

/// Knots that would move by less than this keep their place bit by bit, so that corners stay
/// exactly on corners (tolerance: in fractions of the length, above rounding).
const MIN_SHIFT: f64 = 1e-9;

/// Moves the target place of each knot to where its source point lands under the best-fitting
/// similarity. Returns `None` if the curves are not nearly congruent. `knots` ascend in the source;
/// pins are fixed.
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
        // Only the first residual is decisive: later rounds reduce it.
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
            // Search around the originally matched place, so that the knot cannot drift away over
            // the rounds.
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
    // The registration has failed if half or more of the knots break monotonicity.
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
