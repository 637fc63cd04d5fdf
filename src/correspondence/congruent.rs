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

use super::curve::Curve;
use crate::geometry::{DVec2, Fit};

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

/// The smallest step between knots, as a share of the length.
const LEAST_STEP: f64 = 1e-6;

/// Knots with each source point matched to where it falls on the target,
/// where the curves are nearly the same; none where they are not. `knots` is
/// ascending in the source; pins stay.
pub(super) fn settled(
    knots: &[[f64; 2]],
    pins: &[[f64; 2]],
    [source, target]: [&Curve; 2],
) -> Option<Vec<[f64; 2]>> {
    let length = target.length();
    let mut places: Vec<f64> = knots.iter().map(|k| k[1]).collect();
    let is_held = |k: usize| is_pin(pins, knots[k]);
    let points: Vec<DVec2> = knots.iter().map(|k| source.point_at(k[0])).collect();
    for round in 0..ROUNDS {
        let landed: Vec<DVec2> = places.iter().map(|&b| target.point_at(b)).collect();
        let fit = Fit::of(&points, &landed)?;
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
    let kept = in_order(knots, &settled, pins);
    // What loses many knots did not settle.
    (2 * kept.len() > knots.len()).then_some(kept)
}

fn is_pin(pins: &[[f64; 2]], knot: [f64; 2]) -> bool {
    pins.iter().any(|pin| pin[0] == knot[0])
}

/// The settled knots without those that would step back, pins first. Each is
/// near the knot that was found, so that none is taken for one a round ahead.
fn in_order(found: &[[f64; 2]], settled: &[[f64; 2]], pins: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let is_held = |k: usize| is_pin(pins, found[k]);
    let start = (0..found.len()).find(|&k| is_held(k)).unwrap_or(0);
    let mut path: Vec<(usize, [f64; 2])> = Vec::with_capacity(found.len());
    let moved = |k: usize| {
        let by = settled[k][1] - found[k][1];
        // The shorter way over the seam: nothing moves by half a round.
        by - by.round()
    };
    for offset in 0..found.len() {
        let k = (start + offset) % found.len();
        // Counted on from the start, so that ascending has a meaning.
        let ahead = |side: usize| (found[k][side] - found[start][side]).rem_euclid(1.0);
        let place = [ahead(0), ahead(1) + moved(k)];
        let follows = |last: [f64; 2]| {
            let is_within = place[1] < moved(start) + 1.0 - LEAST_STEP;
            is_within && (0..2).all(|s| place[s] > last[s] + LEAST_STEP)
        };
        if is_held(k) {
            while path.len() > 1 && path.last().is_some_and(|l| !is_held(l.0) && !follows(l.1)) {
                path.pop();
            }
        }
        if offset == 0 || is_held(k) || path.last().is_some_and(|last| follows(last.1)) {
            path.push((k, place));
        }
    }
    let mut kept: Vec<[f64; 2]> = path.into_iter().map(|(k, _)| settled[k]).collect();
    kept.sort_by(|a, b| a[0].total_cmp(&b[0]));
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    fn closed(points: &[(f64, f64)]) -> Curve {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        Curve::closed(&Ring::new(points).expect("a ring")).expect("a size")
    }

    #[test]
    fn unlike_curves_are_left_alone() {
        let square = closed(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let bar = closed(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]);
        let knots = [0.0, 0.25, 0.5, 0.75].map(|place| [place, place]);
        assert_eq!(settled(&knots, &[], [&square, &bar]), None);
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
        let found = settled(&knots, &[], [&shape, &shape]).expect("nearly the same");
        assert!(found.len() > 30);
        for [a, b] in found {
            let off = shape.point_at(a).distance(shape.point_at(b));
            assert!(off < 1e-3 * shape.length(), "{a} at {b}: {off}");
        }
    }

    #[test]
    fn order_is_kept_around_pins() {
        let knots = [[0.1, 0.9], [0.2, 0.05], [0.3, 0.04], [0.4, 0.3], [0.5, 0.2]];
        let pins = [[0.5, 0.2]];
        let found = [[0.1, 0.9], [0.2, 0.02], [0.3, 0.1], [0.4, 0.15], [0.5, 0.2]];
        let kept = in_order(&found, &knots, &pins);
        assert_eq!(kept, [[0.1, 0.9], [0.2, 0.05], [0.5, 0.2]]);
    }

    #[test]
    fn a_first_knot_that_steps_over_the_second_costs_one_knot() {
        let found: Vec<[f64; 2]> = (0..200).map(|k| [f64::from(k) / 200.0; 2]).collect();
        let mut moved = found.clone();
        moved[0][1] = 0.006;
        let kept = in_order(&found, &moved, &[]);
        assert_eq!(kept.len(), 199);
        moved[0][1] = 0.993;
        let kept = in_order(&found, &moved, &[]);
        assert_eq!(kept.len(), 199, "the last one would meet the first");
    }
}
