//! Restores the monotonicity of a match after its knots, the pairs of corresponding places, have
//! been moved.

/// Minimum distance between consecutive knots along either curve, as a fraction of the curve's
/// length (tolerance: invisible, but far above rounding).
const MIN_STEP: f64 = 1e-6;

/// Returns whether a knot is a pin, that is, whether a pin has the same source place.
pub(super) fn is_pin(pins: &[[f64; 2]], knot: [f64; 2]) -> bool {
    pins.iter().any(|pin| pin[0] == knot[0])
}

/// Returns the moved knots without those that would break monotonicity; pins take precedence.
///
/// `original` are the knots before the move, in cyclic order; `moved` are the same knots after it.
/// Each knot must move by less than half of the curve's length, because places are cyclic and a
/// longer move would be ambiguous. The result ascends in the source.
pub(super) fn ordered_knots(
    original: &[[f64; 2]],
    moved: &[[f64; 2]],
    pins: &[[f64; 2]],
) -> Vec<[f64; 2]> {
    let is_pinned = |k: usize| is_pin(pins, original[k]);
    let start = (0..original.len()).find(|&k| is_pinned(k)).unwrap_or(0);
    let mut path: Vec<(usize, [f64; 2])> = Vec::with_capacity(original.len());
    let shift = |k: usize, side: usize| {
        let shift = moved[k][side] - original[k][side];
        // Places are cyclic: take the shorter of the two ways around the curve.
        shift - shift.round()
    };
    for offset in 0..original.len() {
        let k = (start + offset) % original.len();
        // Measure places from the first knot, so that "ascending" is well defined.
        let from_start = |side: usize| (original[k][side] - original[start][side]).rem_euclid(1.0);
        let place = [0, 1].map(|side| from_start(side) + shift(k, side));
        let follows = |last: [f64; 2]| {
            (0..2).all(|s| {
                let is_within = place[s] < shift(start, s) + 1.0 - MIN_STEP;
                is_within && place[s] > last[s] + MIN_STEP
            })
        };
        if is_pinned(k) {
            // A pin removes the preceding knots that would otherwise come after it.
            while path.len() > 1
                && path
                    .last()
                    .is_some_and(|l| !is_pinned(l.0) && !follows(l.1))
            {
                path.pop();
            }
        }
        if offset == 0 || is_pinned(k) || path.last().is_some_and(|last| follows(last.1)) {
            path.push((k, place));
        }
    }
    let mut ordered: Vec<[f64; 2]> = path.into_iter().map(|(k, _)| moved[k]).collect();
    ordered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_take_precedence_over_other_knots() {
        let moved = [[0.1, 0.9], [0.2, 0.05], [0.3, 0.04], [0.4, 0.3], [0.5, 0.2]];
        let pins = [[0.5, 0.2]];
        let original = [[0.1, 0.9], [0.2, 0.02], [0.3, 0.1], [0.4, 0.15], [0.5, 0.2]];
        let ordered = ordered_knots(&original, &moved, &pins);
        assert_eq!(ordered, [[0.1, 0.9], [0.2, 0.05], [0.5, 0.2]]);
    }

    #[test]
    fn a_first_knot_that_passes_its_neighbour_removes_one_knot() {
        let original: Vec<[f64; 2]> = (0..200).map(|k| [f64::from(k) / 200.0; 2]).collect();
        let mut moved = original.clone();
        moved[0][1] = 0.006;
        let ordered = ordered_knots(&original, &moved, &[]);
        assert_eq!(ordered.len(), 199);
        moved[0][1] = 0.993;
        let ordered = ordered_knots(&original, &moved, &[]);
        assert_eq!(ordered.len(), 199, "the last knot would meet the first");
    }
}
