//! Knots of a match that were moved, in an order that is a match again.

/// The smallest step between knots, as a share of the length. Far below what
/// is seen, far above rounding.
const LEAST_STEP: f64 = 1e-6;

/// Whether somebody pinned a knot.
pub(super) fn is_pin(pins: &[[f64; 2]], knot: [f64; 2]) -> bool {
    pins.iter().any(|pin| pin[0] == knot[0])
}

/// The settled knots without those that would step back, pins first. Each is
/// near the knot that was found, so that none is taken for one a round ahead.
/// Those found are in order, cyclically; the outcome ascends in the source.
pub(super) fn ordered_knots(
    found: &[[f64; 2]],
    settled: &[[f64; 2]],
    pins: &[[f64; 2]],
) -> Vec<[f64; 2]> {
    let is_held = |k: usize| is_pin(pins, found[k]);
    let start = (0..found.len()).find(|&k| is_held(k)).unwrap_or(0);
    let mut path: Vec<(usize, [f64; 2])> = Vec::with_capacity(found.len());
    let moved = |k: usize, side: usize| {
        let by = settled[k][side] - found[k][side];
        // The shorter way over the seam: nothing moves by half a round.
        by - by.round()
    };
    for offset in 0..found.len() {
        let k = (start + offset) % found.len();
        // Counted on from the start, so that ascending has a meaning.
        let ahead = |side: usize| (found[k][side] - found[start][side]).rem_euclid(1.0);
        let place = [0, 1].map(|side| ahead(side) + moved(k, side));
        let follows = |last: [f64; 2]| {
            (0..2).all(|s| {
                let is_within = place[s] < moved(start, s) + 1.0 - LEAST_STEP;
                is_within && place[s] > last[s] + LEAST_STEP
            })
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

    #[test]
    fn order_is_kept_around_pins() {
        let knots = [[0.1, 0.9], [0.2, 0.05], [0.3, 0.04], [0.4, 0.3], [0.5, 0.2]];
        let pins = [[0.5, 0.2]];
        let found = [[0.1, 0.9], [0.2, 0.02], [0.3, 0.1], [0.4, 0.15], [0.5, 0.2]];
        let kept = ordered_knots(&found, &knots, &pins);
        assert_eq!(kept, [[0.1, 0.9], [0.2, 0.05], [0.5, 0.2]]);
    }

    #[test]
    fn a_first_knot_that_steps_over_the_second_costs_one_knot() {
        let found: Vec<[f64; 2]> = (0..200).map(|k| [f64::from(k) / 200.0; 2]).collect();
        let mut moved = found.clone();
        moved[0][1] = 0.006;
        let kept = ordered_knots(&found, &moved, &[]);
        assert_eq!(kept.len(), 199);
        moved[0][1] = 0.993;
        let kept = ordered_knots(&found, &moved, &[]);
        assert_eq!(kept.len(), 199, "the last one would meet the first");
    }
}
