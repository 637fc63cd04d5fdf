//! Selects a few automatically matched points to show in the editor: corners of both designs,
//! spread out, and away from pins.

use crate::app::editing::polyline;
use crate::app::editing::sheet_ring::SheetRing;
use crate::correspondence::{PointPair, RingKind};
use crate::geometry::DVec2;

/// Approximate number of points shown on all rings together: enough to notice a shift along the
/// boundary, few enough for their labels not to cover it (heuristic).
const TOTAL_POINTS: f64 = 12.0;

/// Minimum number of points shown on each ring, because the share of a small ring may round to none
/// (heuristic).
const MIN_PER_RING: usize = 2;

/// Distance before and after a vertex over which its turning angle is measured, as a fraction of
/// the ring's length. It is long enough for rounded corners to count, and short enough for
/// flattened curves hardly to count (heuristic).
const TURN_REACH: f64 = 0.03;

/// Score that every vertex has, even if it is no corner. It is above 0, so that circles get points
/// too, and far below the scores that corners add: ½ for the corner of a square, 1 where the ring
/// reverses its direction in both designs (heuristic).
const BASE_SCORE: f64 = 0.02;

/// Selects points of the matched rings, keeping a distance from pins and from each other.
pub fn choose_sample_points(rings: &[SheetRing], pins: &[PointPair]) -> Vec<PointPair> {
    let lengths: Vec<f64> = rings.iter().map(SheetRing::length).collect();
    let total: f64 = lengths.iter().sum();
    let mut features = Vec::new();
    for (ring, length) in rings.iter().zip(&lengths) {
        if ring.kind != RingKind::Matched || total <= 0.0 {
            continue;
        }
        let count = (TOTAL_POINTS * length / total).round() as usize;
        features.extend(choose_on_ring(ring, count.max(MIN_PER_RING), pins));
    }
    features
}

/// Selects at most `count` vertices one after the other, each time the one with the largest product
/// of its corner score and its distance from pins and from the vertices already selected.
fn choose_on_ring(ring: &SheetRing, count: usize, pins: &[PointPair]) -> Vec<PointPair> {
    let scores = scores(ring);
    let mut occupied: Vec<f64> = pins
        .iter()
        .filter_map(|pin| ring.position_of(pin))
        .collect();
    // Minimum gap, as a fraction of the ring's length: half the gap that evenly spaced vertices and
    // pins would have.
    let min_gap = 0.5 / (count + occupied.len()) as f64;
    let mut vertices = Vec::new();
    for _ in 0..count {
        let weighted = ring.positions.iter().enumerate().map(|(k, place)| {
            let near = occupied.iter().map(|other| ring_distance(*place, *other));
            let distance = near.fold(1.0, f64::min);
            let value = if distance < min_gap {
                0.0
            } else {
                // Beyond three times the minimum gap, the distance no longer matters and the
                // sharper corner wins.
                scores[k] * (distance / min_gap).min(3.0)
            };
            (value, k)
        });
        // Ties go to the first vertex, so that a shape always shows the same points.
        let Some((value, k)) = weighted.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
        else {
            break;
        };
        if value <= 0.0 {
            break;
        }
        occupied.push(ring.positions[k]);
        vertices.push(k);
    }
    vertices.sort_unstable();
    let pair = |k: usize| PointPair {
        source: ring.sides[0][k],
        target: ring.sides[1][k],
    };
    vertices.into_iter().map(pair).collect()
}

/// Distance between two arc-length positions on a closed ring of length 1.
fn ring_distance(a: f64, b: f64) -> f64 {
    let gap = (a - b).abs();
    gap.min(1.0 - gap)
}

/// Corner score of each vertex: [`BASE_SCORE`] plus the absolute turning angles at the vertex in
/// the source and in the target, as fractions of a full turn.
fn scores(ring: &SheetRing) -> Vec<f64> {
    let mut scores = vec![BASE_SCORE; ring.positions.len()];
    for points in &ring.sides {
        let (places, _) = polyline::arc_length_positions(points);
        for (k, score) in scores.iter_mut().enumerate() {
            let step = |by: f64| -> DVec2 { polyline::point_at(points, &places, places[k] + by) };
            let turn = polyline::turning_angle(
                points[k] - step(-TURN_REACH),
                step(TURN_REACH) - points[k],
            );
            // A reversal turns by π, so a reversal in both designs scores 1.
            *score += turn.abs() / std::f64::consts::TAU;
        }
    }
    scores
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> SheetRing {
        // A square with three extra points on each edge.
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
        let points: Vec<DVec2> = (0..16)
            .map(|k| corners[k / 4].lerp(corners[(k / 4 + 1) % 4], (k % 4) as f64 / 4.0))
            .collect();
        SheetRing::new(0, RingKind::Matched, [points.clone(), points])
    }

    #[test]
    fn corners_come_first() {
        let points = choose_on_ring(&ring(), 4, &[]);
        let points: Vec<DVec2> = points.iter().map(|pair| pair.source).collect();
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
        assert_eq!(points, corners);
    }

    #[test]
    fn no_point_is_shown_near_a_pin() {
        let pin = PointPair {
            source: DVec2::new(4.0, 0.5),
            target: DVec2::new(4.0, 0.5),
        };
        let points = choose_on_ring(&ring(), 4, &[pin]);
        assert!(!points.is_empty());
        assert!(
            points
                .iter()
                .all(|pair| pair.source.distance(pin.source) > 1.0)
        );
    }

    #[test]
    fn one_ring_shows_about_a_dozen_points() {
        let points = choose_sample_points(&[ring()], &[]);
        assert!((8..=16).contains(&points.len()), "{}", points.len());
    }
}
