//! Measures the total turning of outlines. This measure distinguishes a jagged shape from a smooth
//! one of the same area and length; measures of the distortion of mesh faces cannot distinguish
//! these two.
//!
//! The turning of a ring is the sum of the absolute values of its exterior angles, which is 2π for
//! a convex ring. Rings are first sampled evenly, so that corners count but noise finer than the
//! samples does not.

use super::{DVec2, perimeter};
use std::f64::consts::TAU;

/// Number of samples on a stretch of outline that is as long as the drawing's diameter (heuristic).
const SAMPLES_PER_DIAMETER: f64 = 200.0;

/// Maximum number of samples on one ring (resource limit: 16 MB; an outline needs them only if it is
/// five thousand times as long as the drawing's diameter).
const MAX_SAMPLES: f64 = 1e6;

/// Returns the turning of all rings together, in radians. `diameter`, the diagonal of the bounding
/// box of the whole drawing, sets the distance between samples.
pub(crate) fn total_turning(rings: &[Vec<DVec2>], diameter: f64) -> f64 {
    let step = diameter / SAMPLES_PER_DIAMETER;
    let ring_turning = |ring: &Vec<DVec2>| {
        let points = resample(ring, step);
        let n = points.len();
        let angle = |i: usize| {
            let [a, b, c] = [i, i + 1, i + 2].map(|k| points[k % n]);
            let (incoming, outgoing) = (b - a, c - b);
            incoming
                .perp_dot(outgoing)
                .atan2(incoming.dot(outgoing))
                .abs()
        };
        // A closed ring turns by at least one whole turn, 2π. A degenerate ring counts as one turn.
        (0..n).map(angle).sum::<f64>().max(TAU)
    };
    rings.iter().map(ring_turning).sum()
}

/// Returns evenly spaced points along a closed ring, about `step` apart, at least three; no points
/// if the ring has no length.
fn resample(ring: &[DVec2], step: f64) -> Vec<DVec2> {
    let length = perimeter(ring);
    // The condition is written so that NaN also returns here.
    if !(length.is_finite() && length > 0.0 && step > 0.0) {
        return Vec::new();
    }
    let count = (length / step).round().clamp(3.0, MAX_SAMPLES);
    let mut points = Vec::with_capacity(count as usize);
    let mut covered = 0.0;
    for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let side = a.distance(*b);
        while points.len() < count as usize {
            let along = points.len() as f64 * length / count - covered;
            if along > side {
                break;
            }
            points.push(a.lerp(*b, if side > 0.0 { along / side } else { 0.0 }));
        }
        covered += side;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from(p)).collect()
    }

    #[test]
    fn convex_outlines_turn_once() {
        let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert!((total_turning(std::slice::from_ref(&square), 1.5) - TAU).abs() < 1e-9);
        assert!((total_turning(&[square.clone(), square], 1.5) - 2.0 * TAU).abs() < 1e-9);
    }

    #[test]
    fn each_tooth_adds_turning() {
        let mut saw: Vec<DVec2> = (0..=40)
            .map(|k| DVec2::new(f64::from(k) * 0.025, 0.05 * f64::from(k % 2)))
            .collect();
        saw.extend([DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0)]);
        assert!(total_turning(&[saw], 1.4) > 8.0 * TAU);
    }

    #[test]
    fn a_ring_without_length_turns_once() {
        assert_eq!(total_turning(&[vec![DVec2::ONE; 3]], 1.0), TAU);
        assert_eq!(total_turning(&[], 1.0), 0.0);
    }
}
