//! How much outlines turn: what tells a jagged form from a smooth one of the
//! same area and length, which no distortion of faces does.
//!
//! W = Σ |exterior angle|, 2π for each convex ring. Outlines are sampled
//! evenly first, so that a corner counts and noise finer than the eye does not.

use super::{DVec2, perimeter};
use std::f64::consts::TAU;

/// Samples along the diameter of what is drawn.
const ALONG_DIAMETER: f64 = 200.0;

/// By how much all rings turn, in radians; `diameter` is that of the whole.
pub(crate) fn total_turning(rings: &[Vec<DVec2>], diameter: f64) -> f64 {
    let step = diameter / ALONG_DIAMETER;
    let of = |ring: &Vec<DVec2>| {
        let points = sampled(ring, step);
        let n = points.len();
        let angle = |i: usize| {
            let [a, b, c] = [i, i + 1, i + 2].map(|k| points[k % n]);
            let (come, go) = (b - a, c - b);
            come.perp_dot(go).atan2(come.dot(go)).abs()
        };
        // The least ring turns once, one without length as well.
        (0..n).map(angle).sum::<f64>().max(TAU)
    };
    rings.iter().map(of).sum()
}

/// Points along a closed ring, evenly: one a step, three at least.
fn sampled(ring: &[DVec2], step: f64) -> Vec<DVec2> {
    let length = perimeter(ring);
    if !(length.is_finite() && length > 0.0 && step > 0.0) {
        return Vec::new();
    }
    let count = (length / step).round().max(3.0);
    let mut points = Vec::with_capacity(count as usize);
    let mut walked = 0.0;
    for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let side = a.distance(*b);
        while points.len() < count as usize {
            let along = points.len() as f64 * length / count - walked;
            if along > side {
                break;
            }
            points.push(a.lerp(*b, if side > 0.0 { along / side } else { 0.0 }));
        }
        walked += side;
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
    fn what_is_convex_turns_once() {
        let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert!((total_turning(std::slice::from_ref(&square), 1.5) - TAU).abs() < 1e-9);
        assert!((total_turning(&[square.clone(), square], 1.5) - 2.0 * TAU).abs() < 1e-9);
    }

    #[test]
    fn teeth_turn_there_and_back() {
        let mut saw: Vec<DVec2> = (0..=40)
            .map(|k| DVec2::new(f64::from(k) * 0.025, 0.05 * f64::from(k % 2)))
            .collect();
        saw.extend([DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0)]);
        assert!(total_turning(&[saw], 1.4) > 8.0 * TAU);
    }

    #[test]
    fn a_ring_without_length_turns_as_the_least_ring_does() {
        assert_eq!(total_turning(&[vec![DVec2::ONE; 3]], 1.0), TAU);
        assert_eq!(total_turning(&[], 1.0), 0.0);
    }
}
