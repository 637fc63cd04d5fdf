//! Pins: pairs of places that the user says are the same.

use super::curve::BoundaryCurve;
use crate::geometry::SourceTarget;

/// A place of the source and one of the target that are the same point, each
/// as a fraction of its curve's length from the first point.
/// [`BoundaryCurve::nearest`] gives that of a clicked point.
pub type Pin = SourceTarget<f64>;

/// Pins that no continuous match can honour; in messages they count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PinError {
    /// A place is NaN or infinite.
    #[error("pin {} does not lie on the outline; place it anew", .0 + 1)]
    NotFinite(usize),
    /// Two pins share a point of one outline but not of the other.
    #[error("pins {} and {} say different things of one point; move or delete one of them", .0 + 1, .1 + 1)]
    SamePoint(usize, usize),
    /// The pins follow each other differently on the two outlines.
    #[error(
        "pins {} and {} cross: they follow each other in another order on the other outline; \
         move or delete one of them",
        .0 + 1, .1 + 1
    )]
    Crossing(usize, usize),
}

/// The pins in the order of the source, places wrapped, repetitions left out.
/// The order of the target may start anywhere.
pub(super) fn ordered(
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
    // A pin that was set twice says nothing new.
    places.dedup_by_key(|(place, _)| *place);
    check_shared(&places)?;
    check_order(&places)?;
    Ok(places.into_iter().map(|(place, _)| place).collect())
}

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

/// Names a pin outside the longest series in order, and the one it crosses.
fn check_order(pins: &[([f64; 2], usize)]) -> Result<(), PinError> {
    let n = pins.len();
    // In order, the target's places fall once in a round: at its seam.
    let falls = |k: usize| pins[k].0[1] > pins[(k + 1) % n].0[1];
    if (0..n).filter(|&k| falls(k)).count() <= 1 {
        return Ok(());
    }
    let series = (0..n).map(|start| rising(pins, start));
    let kept = series.max_by_key(Vec::len).unwrap_or_default();
    let odd = (0..n).find(|k| !kept.contains(k)).unwrap_or(0);
    let turned = |place: f64| (place - pins[kept[0]].0[1]).rem_euclid(1.0);
    let ahead = |k: usize| (k + n - kept[0]) % n;
    let crossed =
        |&&k: &&usize| (ahead(k) < ahead(odd)) != (turned(pins[k].0[1]) < turned(pins[odd].0[1]));
    let other = kept.iter().find(crossed).copied().unwrap_or(kept[0]);
    let (a, b) = (pins[odd].1, pins[other].1);
    Err(PinError::Crossing(a.min(b), a.max(b)))
}

/// The longest series from `start` on that rises in the target too.
fn rising(pins: &[([f64; 2], usize)], start: usize) -> Vec<usize> {
    let n = pins.len();
    let base = pins[start].0[1];
    let value = |k: usize| (pins[(start + k) % n].0[1] - base).rem_euclid(1.0);
    let mut best: Vec<(usize, usize)> = Vec::with_capacity(n); // length, predecessor
    for k in 0..n {
        let before = (0..k).filter(|&b| value(b) < value(k));
        let longest = before.max_by_key(|&b| best[b].0);
        best.push(longest.map_or((1, k), |b| (best[b].0 + 1, b)));
    }
    let mut k = (0..n).max_by_key(|&k| best[k].0).unwrap_or(0);
    let mut series = vec![(start + k) % n];
    while best[k].1 != k {
        k = best[k].1;
        series.push((start + k) % n);
    }
    series.reverse();
    series
}
