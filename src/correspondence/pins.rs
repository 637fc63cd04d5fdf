//! Pins (pairs of corresponding places) on two curves: sorts them, and rejects those that no
//! continuous match can satisfy.

use super::curve::BoundaryCurve;
use crate::geometry::SourceTarget;

/// A pair of corresponding places on two curves, each as a fraction of the curve's length from its
/// first point. [`BoundaryCurve::nearest`] converts a clicked point to a place.
pub type Pin = SourceTarget<f64>;

/// Error for pins that no continuous match can satisfy. The indices of pins start at 0 in the
/// fields and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PinError {
    /// A place of the pin with this index is NaN or infinite.
    #[error("pin {} does not lie on the outline; place it again", .0 + 1)]
    NotFinite(usize),
    /// Two pins share a point of one outline but not of the other.
    #[error("pins {} and {} tie one point to two different points; move or delete one of them", .0 + 1, .1 + 1)]
    SamePoint(usize, usize),
    /// The pins have different cyclic orders on the two outlines.
    #[error(
        "pins {} and {} cross: their order differs between the two outlines; \
         move or delete one of them",
        .0 + 1, .1 + 1
    )]
    Crossing(usize, usize),
}

/// Returns the pins sorted by their places on the source, with places wrapped to [0, 1) and
/// duplicates removed. The target places are ascending up to a cyclic shift.
///
/// # Errors
/// [`PinError`] for pins that contradict each other.
pub(super) fn sort_pins(
    pins: &[Pin],
    source: &BoundaryCurve,
    target: &BoundaryCurve,
) -> Result<Vec<[f64; 2]>, PinError> {
    let mut places = Vec::with_capacity(pins.len());
    for (k, pin) in pins.iter().enumerate() {
        if !(pin.source.is_finite() && pin.target.is_finite()) {
            return Err(PinError::NotFinite(k));
        }
        let place = [source.wrapped(pin.source), target.wrapped(pin.target)];
        places.push((place, k));
    }
    places.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // Identical pins are redundant, not contradictory.
    places.dedup_by_key(|(place, _)| *place);
    check_shared(&places)?;
    check_order(&places)?;
    Ok(places.into_iter().map(|(place, _)| place).collect())
}

/// Checks that no two pins share a place on one curve.
fn check_shared(pins: &[([f64; 2], usize)]) -> Result<(), PinError> {
    for side in 0..2 {
        let mut sorted = pins.to_vec();
        sorted.sort_by(|(a, _), (b, _)| a[side].total_cmp(&b[side]));
        let shared = sorted.windows(2).find(|w| w[0].0[side] == w[1].0[side]);
        if let Some(pair) = shared {
            let (a, b) = (pair[0].1, pair[1].1);
            return Err(PinError::SamePoint(a.min(b), a.max(b)));
        }
    }
    Ok(())
}

/// Checks that both curves have the pins in the same cyclic order. The error names a pin outside
/// the longest consistent sequence, and a pin that it crosses.
fn check_order(pins: &[([f64; 2], usize)]) -> Result<(), PinError> {
    let n = pins.len();
    // In cyclic order, the target places decrease exactly once per round: from near 1 to near 0.
    let decreases_after = |k: usize| pins[k].0[1] > pins[(k + 1) % n].0[1];
    if (0..n).filter(|&k| decreases_after(k)).count() <= 1 {
        return Ok(());
    }
    let sequences = (0..n).map(|start| longest_ascending(pins, start));
    let longest = sequences.max_by_key(Vec::len).unwrap_or_default();
    let offending = (0..n).find(|k| !longest.contains(k)).unwrap_or(0);
    let target_offset = |place: f64| (place - pins[longest[0]].0[1]).rem_euclid(1.0);
    let source_offset = |k: usize| (k + n - longest[0]) % n;
    let is_crossed = |&&k: &&usize| {
        (source_offset(k) < source_offset(offending))
            != (target_offset(pins[k].0[1]) < target_offset(pins[offending].0[1]))
    };
    let other = longest
        .iter()
        .find(is_crossed)
        .copied()
        .unwrap_or(longest[0]);
    let (a, b) = (pins[offending].1, pins[other].1);
    Err(PinError::Crossing(a.min(b), a.max(b)))
}

/// Returns the indices of the longest subsequence of the pins, in cyclic order from `start` on,
/// whose target places ascend too (dynamic program, O(n²)).
fn longest_ascending(pins: &[([f64; 2], usize)], start: usize) -> Vec<usize> {
    let n = pins.len();
    let base = pins[start].0[1];
    let value = |k: usize| (pins[(start + k) % n].0[1] - base).rem_euclid(1.0);
    let mut best: Vec<(usize, usize)> = Vec::with_capacity(n); // length, predecessor
    for k in 0..n {
        let predecessors = (0..k).filter(|&b| value(b) < value(k));
        let longest = predecessors.max_by_key(|&b| best[b].0);
        best.push(longest.map_or((1, k), |b| (best[b].0 + 1, b)));
    }
    let mut k = (0..n).max_by_key(|&k| best[k].0).unwrap_or(0);
    let mut sequence = vec![(start + k) % n];
    while best[k].1 != k {
        k = best[k].1;
        sequence.push((start + k) % n);
    }
    sequence.reverse();
    sequence
}
