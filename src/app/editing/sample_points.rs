//! The few corresponding points that the editor shows of a match: corners of both sides, spread
//! out, none near a pin.

use crate::app::editing::polyline;
use crate::app::editing::sheet_ring::SheetRing;
use crate::correspondence::{PointPair, RingKind};
use crate::geometry::DVec2;

/// How many points are shown of all rings together, more or less: enough to tell a shift along the
/// boundary, few enough for their numbers not to cover it.
const MANY: f64 = 12.0;

/// The least that are shown of a ring: the share of a small one may be none.
const FEW: usize = 2;

/// A corner is what turns over this share of the ring before and after it: a rounded one counts,
/// and what was flattened from a curve hardly does.
const REACH: f64 = 0.03;

/// What a place that is no corner counts for, against one for a reversal on both sides: above 0,
/// so that a circle gets points too, and far below the half of a square's corner.
const PLAIN: f64 = 0.02;

/// Chooses points of the matched rings; places nearer to a pin than to the next point are left
/// free.
pub fn chosen(rings: &[SheetRing], pins: &[PointPair]) -> Vec<PointPair> {
    let lengths: Vec<f64> = rings.iter().map(SheetRing::length).collect();
    let total: f64 = lengths.iter().sum();
    let mut features = Vec::new();
    for (ring, length) in rings.iter().zip(&lengths) {
        if ring.kind != RingKind::Matched || total <= 0.0 {
            continue;
        }
        let count = (MANY * length / total).round() as usize;
        features.extend(of_ring(ring, count.max(FEW), pins));
    }
    features
}

/// The best vertex, again and again, where those far from what is there count more.
fn of_ring(ring: &SheetRing, count: usize, pins: &[PointPair]) -> Vec<PointPair> {
    let scores = scores(ring);
    let mut taken: Vec<f64> = pins.iter().filter_map(|pin| ring.place_of(pin)).collect();
    // Half the gap that there would be if all lay at even distances on the ring of length 1.
    let room = 0.5 / (count + taken.len()) as f64;
    let mut vertices = Vec::new();
    for _ in 0..count {
        let weighed = ring.places.iter().enumerate().map(|(k, place)| {
            let near = taken.iter().map(|other| apart(*place, *other));
            let distance = near.fold(1.0, f64::min);
            let value = if distance < room {
                0.0
            } else {
                // Beyond three times the room it is far enough, and the sharper corner wins.
                scores[k] * (distance / room).min(3.0)
            };
            (value, k)
        });
        // The first of equals, so that a shape shows the same points each time.
        let Some((value, k)) = weighed.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
        else {
            break;
        };
        if value <= 0.0 {
            break;
        }
        taken.push(ring.places[k]);
        vertices.push(k);
    }
    vertices.sort_unstable();
    let pair = |k: usize| PointPair {
        source: ring.sides[0][k],
        target: ring.sides[1][k],
    };
    vertices.into_iter().map(pair).collect()
}

/// The way between two places on a round of length 1.
fn apart(a: f64, b: f64) -> f64 {
    let gap = (a - b).abs();
    gap.min(1.0 - gap)
}

/// How much of a corner each vertex is, on both sides together.
fn scores(ring: &SheetRing) -> Vec<f64> {
    let mut scores = vec![PLAIN; ring.places.len()];
    for points in &ring.sides {
        let (places, _) = polyline::places(points);
        for (k, score) in scores.iter_mut().enumerate() {
            let step = |by: f64| -> DVec2 { polyline::point_at(points, &places, places[k] + by) };
            let turn = polyline::turn(points[k] - step(-REACH), step(REACH) - points[k]);
            // A reversal is half a turn, so on both sides together it comes to 1.
            *score += turn.abs() / std::f64::consts::TAU;
        }
    }
    scores
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> SheetRing {
        // A square with three points on each edge besides its corners.
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
        let points: Vec<DVec2> = (0..16)
            .map(|k| corners[k / 4].lerp(corners[(k / 4 + 1) % 4], (k % 4) as f64 / 4.0))
            .collect();
        SheetRing::new(0, RingKind::Matched, [points.clone(), points])
    }

    #[test]
    fn corners_come_first() {
        let found = of_ring(&ring(), 4, &[]);
        let points: Vec<DVec2> = found.iter().map(|pair| pair.source).collect();
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
        assert_eq!(points, corners);
    }

    #[test]
    fn nothing_is_shown_next_to_a_pin() {
        let pin = PointPair {
            source: DVec2::new(4.0, 0.5),
            target: DVec2::new(4.0, 0.5),
        };
        let found = of_ring(&ring(), 4, &[pin]);
        assert!(!found.is_empty());
        assert!(
            found
                .iter()
                .all(|pair| pair.source.distance(pin.source) > 1.0)
        );
    }

    #[test]
    fn about_a_dozen_is_shown_of_one_ring() {
        let found = chosen(&[ring()], &[]);
        assert!((8..=16).contains(&found.len()), "{}", found.len());
    }
}
