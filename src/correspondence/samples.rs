//! Places along a curve at which it is compared: corners, pins, and an even
//! spacing between them.
//!
//! A corner is a point where the direction jumps: its turning hardly shrinks
//! when the reach over which it is taken does. On a smooth bend the turning is
//! proportional to the reach, however many points draw the bend, so that
//! corners do not depend on the resolution of the outline.

use super::curve::BoundaryCurve;

/// Reach of the turning by which corners are found, in fractions of the
/// length; an outline of 140 even points has this spacing.
const CORNER_REACH: f64 = 0.007;

/// Least turning of a corner, in radians: 40°.
const CORNER_TURN: f64 = 0.7;

/// What must be left of the turning at a quarter of the reach. A circular arc
/// keeps 0.25, a jump 1.
const CORNER_SHARPNESS: f64 = 0.6;

/// Least gap between a corner and its neighbours, in sample spacings; a
/// denser comb is compared at its strongest corners only.
const LEAST_GAP: f64 = 0.5;

/// Sampled places in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurveSamples {
    pub places: Vec<f64>,
}

impl CurveSamples {
    /// About `count` places; `fixed` ones (pins) are among them whatever
    /// their gaps.
    pub fn of(curve: &BoundaryCurve, count: u32, fixed: &[f64]) -> Self {
        let spacing = 1.0 / f64::from(count.max(3));
        let anchors = anchors(curve, spacing, fixed);
        let mut places = Vec::new();
        for (k, &from) in anchors.iter().enumerate() {
            let to = anchors.get(k + 1).copied().unwrap_or(anchors[0] + 1.0);
            fill(&mut places, from, to, spacing);
        }
        places.iter_mut().for_each(|p| *p = curve.wrapped(*p));
        places.sort_by(f64::total_cmp);
        places.dedup();
        Self { places }
    }

    /// The index of a place that is among them.
    pub fn index_of(&self, place: f64) -> Option<usize> {
        self.places.binary_search_by(|p| p.total_cmp(&place)).ok()
    }

    /// The sample nearest to a place, both counted on over the seam.
    pub fn nearest(&self, place: f64) -> usize {
        let round = place.floor();
        let after = self.places.partition_point(|&p| p < place - round);
        let after = after + self.places.len() * round as usize;
        let is_before = |k: &usize| place - self.unrolled(*k) < self.unrolled(after) - place;
        after.checked_sub(1).filter(is_before).unwrap_or(after)
    }

    /// Place of a sample counted on over the seam.
    pub fn unrolled(&self, index: usize) -> f64 {
        let n = self.places.len();
        self.places[index % n] + (index / n) as f64
    }
}

/// `from` and even places up to `to`, exclusive.
fn fill(places: &mut Vec<f64>, from: f64, to: f64, spacing: f64) {
    let pieces = ((to - from) / spacing).round().max(1.0);
    let step = (to - from) / pieces;
    let count = pieces as u32;
    places.extend((0..count).map(|k| from + step * f64::from(k)));
}

/// What is kept exactly: pins and corners; at least one place, so that the
/// phase of the samples does not depend on where the outline starts.
fn anchors(curve: &BoundaryCurve, spacing: f64, fixed: &[f64]) -> Vec<f64> {
    let mut kept = fixed.to_vec();
    kept.sort_by(f64::total_cmp);
    kept.dedup();
    // The strongest first: where corners crowd, the weaker give way.
    for (place, _) in corners(curve) {
        insert_apart(&mut kept, place, LEAST_GAP * spacing);
    }
    if kept.is_empty() {
        kept.push(bendiest(curve));
    }
    kept
}

/// Inserts in order unless something is nearer than `gap`; tells whether.
fn insert_apart(kept: &mut Vec<f64>, place: f64, gap: f64) -> bool {
    let at = kept.partition_point(|&k| k < place);
    let before = match at.checked_sub(1) {
        Some(k) => kept[k],
        None => kept.last().map_or(f64::NEG_INFINITY, |last| last - 1.0),
    };
    let first = || kept.first().map_or(f64::INFINITY, |first| first + 1.0);
    let after = kept.get(at).copied().unwrap_or_else(first);
    let fits = place - before >= gap && after - place >= gap;
    if fits {
        kept.insert(at, place);
    }
    fits
}

/// Places of corners with their absolute turning, the strongest first. The
/// points next to a corner see it too: they are left out.
pub(super) fn corners(curve: &BoundaryCurve) -> Vec<(f64, f64)> {
    let near_reach = 0.25 * CORNER_REACH;
    let is_corner = |&place: &f64| {
        let wide = curve.turning(place, CORNER_REACH).abs();
        let near = curve.turning(place, near_reach).abs();
        (wide >= CORNER_TURN && near >= CORNER_SHARPNESS * wide).then_some((place, near))
    };
    let mut seen: Vec<(f64, f64)> = curve.places().iter().filter_map(is_corner).collect();
    seen.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    let mut kept = Vec::new();
    seen.retain(|&(place, _)| insert_apart(&mut kept, place, near_reach));
    seen
}

/// The point of greatest turning, taken wide.
fn bendiest(curve: &BoundaryCurve) -> f64 {
    let turn = |place: f64| curve.turning(place, 4.0 * CORNER_REACH).abs();
    let mut best = (f64::NEG_INFINITY, 0.0);
    for &place in curve.places() {
        let turn = turn(place);
        if turn > best.0 {
            best = (turn, place);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DVec2, Ring};
    use std::f64::consts::TAU;

    fn curve(points: Vec<DVec2>) -> BoundaryCurve {
        BoundaryCurve::closed(&Ring::new(points).expect("a ring")).expect("a size")
    }

    fn square(per_side: u32) -> BoundaryCurve {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let side = |k: usize| {
            (0..per_side).map(move |i| {
                corners[k].lerp(corners[(k + 1) % 4], f64::from(i) / f64::from(per_side))
            })
        };
        curve((0..4).flat_map(side).collect())
    }

    #[test]
    fn a_square_has_four_corners_at_any_resolution() {
        for per_side in [1, 2, 7, 50, 333] {
            let square = square(per_side);
            assert_eq!(corners(&square).len(), 4, "{per_side} edges a side");
            let samples = CurveSamples::of(&square, 100, &[]);
            assert_eq!(samples.places.len(), 100);
            for k in 0..4 {
                let place = 0.25 * f64::from(k);
                assert!(samples.places.iter().any(|p| (p - place).abs() < 1e-12));
            }
        }
    }

    #[test]
    fn a_circle_has_none() {
        for n in [24, 60, 1000] {
            let point = |k: u32| DVec2::from_angle(TAU * f64::from(k) / f64::from(n));
            let circle = curve((0..n).map(point).collect());
            assert!(corners(&circle).is_empty(), "{n} points");
            assert_eq!(CurveSamples::of(&circle, 160, &[]).places.len(), 160);
        }
    }

    #[test]
    fn pins_are_samples_even_where_they_crowd() {
        let pins = [0.1, 0.1 + 1e-9, 0.25 + 1e-7];
        let samples = CurveSamples::of(&square(1), 50, &pins);
        assert!(pins.iter().all(|&pin| samples.index_of(pin).is_some()));
        assert!(samples.places.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(samples.index_of(0.25), None);
    }
}
