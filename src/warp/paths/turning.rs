//! Continuous edge angles of two corresponding rings.
//!
//! An edge direction determines its angle only modulo 2π. Along the ring, angles are made
//! continuous by adding the turning angle at each vertex, in (−π, π] (Sederberg, Gao, Wang, Mu
//! 1993, §3). The rotation from source to target then changes from edge to edge only by the
//! difference of the turning angles. A simple ring turns by ±2π in total. Where a ring reverses
//! its direction, the sign of that half turn is chosen so that the total is right.

use crate::geometry::DVec2;
use std::f64::consts::{PI, TAU};

/// Difference from π in radians below which a turning angle is a reversal with undetermined sign
/// (tolerance: the two sides of a cut coincide up to rounding).
const REVERSAL_TOLERANCE: f64 = 1e-6;

/// Returns the vector from each point to the next; the closing edge comes last.
pub(super) fn edges(ring: &[DVec2]) -> impl Iterator<Item = DVec2> + Clone + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| *b - *a)
}

/// Returns `[angle in the source, rotation from source to target]` of each edge, in radians.
///
/// The rotations are consistent along the ring, but determined only up to a common multiple of 2π.
/// An edge of zero length in one of the rings rotates like the edge before it. If no edge has a
/// length in both rings, all rotate by `default_turn`.
pub(super) fn turns(source: &[DVec2], target: &[DVec2], default_turn: f64) -> Vec<[f64; 2]> {
    let directions = [continuous_angles(source), continuous_angles(target)];
    let turn_of = |k: usize| Some(directions[1][k]? - directions[0][k]?);
    let count = source.len();
    // The ring is closed, so the last edge precedes the first.
    let last_known = (0..count).rev().find_map(turn_of);
    let mut turn = last_known.unwrap_or(default_turn);
    (0..count)
        .map(|k| {
            turn = turn_of(k).unwrap_or(turn);
            let from_target = directions[1][k].map(|angle| angle - turn);
            [directions[0][k].or(from_target).unwrap_or(0.0), turn]
        })
        .collect()
}

/// Returns the multiple of 2π that brings `angle` nearest to `near`.
pub(super) fn whole_turns(angle: f64, near: f64) -> f64 {
    TAU * ((near - angle) / TAU).round()
}

/// Returns the angle of each edge that has a length, continuous along the ring.
fn continuous_angles(ring: &[DVec2]) -> Vec<Option<f64>> {
    let directions: Vec<DVec2> = edges(ring).map(DVec2::normalize_or_zero).collect();
    let proper: Vec<usize> = (0..directions.len())
        .filter(|&k| directions[k] != DVec2::ZERO)
        .collect();
    let mut angles = vec![None; ring.len()];
    let Some(&first) = proper.first() else {
        return angles;
    };
    let next = proper.iter().cycle().skip(1);
    let mut turning: Vec<f64> = proper
        .iter()
        .zip(next)
        .map(|(&a, &b)| directions[a].angle_to(directions[b]))
        .collect();
    fix_reversals(&mut turning, ring);
    let mut angle = directions[first].to_angle();
    for (&k, turn) in proper.iter().zip(turning) {
        angles[k] = Some(angle);
        angle += turn;
    }
    angles
}

/// Chooses the signs of the turning angles at the vertices where the ring reverses its direction,
/// so that the ring turns exactly once in total.
fn fix_reversals(turning: &mut [f64], ring: &[DVec2]) {
    let origin = ring.first().copied().unwrap_or_default();
    let twice_area: f64 = edges(ring)
        .zip(ring)
        .map(|(edge, &p)| (p - origin).perp_dot(edge))
        .sum();
    let expected = TAU.copysign(twice_area);
    let mut missing = ((expected - turning.iter().sum::<f64>()) / TAU).round();
    for turn in turning.iter_mut() {
        // Both signs are possible only where the ring reverses its direction.
        let can_flip = PI - turn.abs() < REVERSAL_TOLERANCE && *turn * missing < 0.0;
        if can_flip {
            *turn += TAU.copysign(missing);
            missing -= 1.0_f64.copysign(missing);
        }
        if missing == 0.0 {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().copied().map(DVec2::from).collect()
    }

    fn total(ring: &[DVec2]) -> f64 {
        let angles: Vec<f64> = continuous_angles(ring).into_iter().flatten().collect();
        let last = edges(ring).last().unwrap_or_default();
        let first = edges(ring).next().unwrap_or_default();
        angles[angles.len() - 1] - angles[0] + last.angle_to(first)
    }

    #[test]
    fn a_simple_ring_turns_once() {
        let square = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert!((total(&square) - TAU).abs() < 1e-12);
        let hole: Vec<DVec2> = square.into_iter().rev().collect();
        assert!((total(&hole) + TAU).abs() < 1e-12);
    }

    #[test]
    fn a_slit_reverses_inwards_and_a_spike_outwards() {
        let slit = points(&[
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 2.0),
            (1.0, 2.0),
            (4.0, 2.0),
            (4.0, 4.0),
            (0.0, 4.0),
        ]);
        assert!((total(&slit) - TAU).abs() < 1e-12);
        let spike = points(&[
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 2.0),
            (7.0, 2.0),
            (4.0, 2.0),
            (4.0, 4.0),
            (0.0, 4.0),
        ]);
        assert!((total(&spike) - TAU).abs() < 1e-12);
    }

    #[test]
    fn an_edge_of_zero_length_turns_like_its_neighbour() {
        let source = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        let target = points(&[(0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (-1.0, 2.0)]);
        for [_, turn] in turns(&source, &target, 0.0).iter().take(2) {
            assert!((turn - PI / 2.0).abs() < 1e-12, "{turn}");
        }
        let point = vec![DVec2::ONE; 4];
        assert!(turns(&point, &target, 0.7).iter().all(|t| t[1] == 0.7));
    }
}
