//! Chooses the places at which a curve is sampled: corners, pins, and evenly spaced places between
//! them. A place is a fraction of the curve's arc length.
//!
//! A corner is a point where the direction jumps: its turning hardly decreases when it is measured
//! over a shorter section. On a smooth bend the turning is proportional to the length of the
//! section, no matter how many vertices the bend has. Corner detection therefore does not depend on
//! the outline's resolution.

use super::curve::BoundaryCurve;

/// Half-length of the section over which turning is measured to find corners, as a fraction of the
/// curve's length: the edge length of an outline with about 140 equal edges (heuristic).
const CORNER_REACH: f64 = 0.007;

/// Minimum turning of a corner, in radians: 40° (heuristic).
const CORNER_TURN: f64 = 0.7;

/// Minimum fraction of a corner's turning that remains if it is measured over a quarter of the
/// length. A circular arc keeps 0.25, a jump 1; the threshold lies about halfway (heuristic).
const CORNER_SHARPNESS: f64 = 0.6;

/// Minimum gap between a corner and the next corner or pin, in sample spacings. Of corners that lie
/// closer together, only the strongest becomes a sample (heuristic).
const MIN_GAP: f64 = 0.5;

/// Places (fractions of the curve's length) at which a curve is sampled, ascending.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurveSamples {
    pub places: Vec<f64>,
}

impl CurveSamples {
    /// Samples the curve at about `count` places. All `fixed` places (pins) are among them, however
    /// close they are to each other.
    pub fn of(curve: &BoundaryCurve, count: u32, fixed: &[f64]) -> Self {
        let spacing = 1.0 / f64::from(count.max(3));
        let anchors = anchor_places(curve, spacing, fixed);
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

    /// Returns the index of the sample that lies exactly at a place; `None` if there is none.
    pub fn index_of(&self, place: f64) -> Option<usize> {
        self.places.binary_search_by(|p| p.total_cmp(&place)).ok()
    }

    /// Returns the index of the sample nearest to a non-negative place. Places and indices continue
    /// from round to round: with n samples, place 1 and index n are place 0 and sample 0 again.
    pub fn nearest(&self, place: f64) -> usize {
        let round = place.floor();
        let after = self.places.partition_point(|&p| p < place - round);
        let after = after + self.places.len() * round as usize;
        let is_before =
            |k: &usize| place - self.unwrapped_place(*k) < self.unwrapped_place(after) - place;
        after.checked_sub(1).filter(is_before).unwrap_or(after)
    }

    /// Returns the place of a sample whose index continues from round to round: the place of sample
    /// `index % n`, plus one for each full round.
    pub fn unwrapped_place(&self, index: usize) -> f64 {
        let n = self.places.len();
        self.places[index % n] + (index / n) as f64
    }
}

/// Appends evenly spaced places from `from`, inclusive, to `to`, exclusive; they are about
/// `spacing` apart.
fn fill(places: &mut Vec<f64>, from: f64, to: f64, spacing: f64) {
    let pieces = ((to - from) / spacing).round().max(1.0);
    let step = (to - from) / pieces;
    let count = pieces as u32;
    places.extend((0..count).map(|k| from + step * f64::from(k)));
}

/// Returns the places that must be samples exactly: pins and corners. There is at least one, so
/// that the samples do not depend on the point at which the outline starts.
fn anchor_places(curve: &BoundaryCurve, spacing: f64, fixed: &[f64]) -> Vec<f64> {
    let mut anchors = fixed.to_vec();
    anchors.sort_by(f64::total_cmp);
    anchors.dedup();
    // Strongest first: where corners crowd, the weaker ones are dropped.
    for (place, _) in corners(curve) {
        insert_unless_close(&mut anchors, place, MIN_GAP * spacing);
    }
    if anchors.is_empty() {
        anchors.push(sharpest_bend(curve));
    }
    anchors
}

/// Inserts a place into the ascending list unless another is closer than `gap`, cyclically. Returns
/// whether it was inserted.
fn insert_unless_close(places: &mut Vec<f64>, place: f64, gap: f64) -> bool {
    let index = places.partition_point(|&k| k < place);
    let before = match index.checked_sub(1) {
        Some(k) => places[k],
        None => places.last().map_or(f64::NEG_INFINITY, |last| last - 1.0),
    };
    let first = || places.first().map_or(f64::INFINITY, |first| first + 1.0);
    let after = places.get(index).copied().unwrap_or_else(first);
    let is_apart = place - before >= gap && after - place >= gap;
    if is_apart {
        places.insert(index, place);
    }
    is_apart
}

/// Returns the places of corners with their absolute turning in radians, strongest first. Points
/// next to a corner, whose turning includes that of the corner, are suppressed.
pub(super) fn corners(curve: &BoundaryCurve) -> Vec<(f64, f64)> {
    let narrow_reach = 0.25 * CORNER_REACH;
    let is_corner = |&place: &f64| {
        let wide = curve.turning(place, CORNER_REACH).abs();
        let narrow = curve.turning(place, narrow_reach).abs();
        (wide >= CORNER_TURN && narrow >= CORNER_SHARPNESS * wide).then_some((place, narrow))
    };
    let mut candidates: Vec<(f64, f64)> = curve.places().iter().filter_map(is_corner).collect();
    candidates.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    let mut inserted = Vec::new();
    candidates.retain(|&(place, _)| insert_unless_close(&mut inserted, place, narrow_reach));
    candidates
}

/// Returns the place of the vertex with the largest turning, measured over long sections.
fn sharpest_bend(curve: &BoundaryCurve) -> f64 {
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
