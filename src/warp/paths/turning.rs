//! Directions of the edges of two corresponding rings as continuous angles.
//!
//! A direction is known modulo 2π only. Walked along the ring it is lifted by
//! the turning angle at each vertex, in (−π, π], so that the difference of two
//! rings' directions changes from edge to edge by the difference of their
//! turning angles alone (Sederberg, Gao, Wang, Mu 1993, §3). A simple ring
//! turns by ±2π in all; where it turns straight back on itself, the sign of
//! that half turn is the one with which the sum comes out.

use crate::geometry::DVec2;
use std::f64::consts::{PI, TAU};

/// A turning angle this near to π, in radians, may as well be −π: the two
/// sides of a cut lie on each other to rounding.
const STRAIGHT_BACK: f64 = 1e-6;

/// The edge from each point to the next, the closing one last.
pub(super) fn edges(ring: &[DVec2]) -> impl Iterator<Item = DVec2> + Clone + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| *b - *a)
}

/// The angle of each edge from the source to the target, as `[angle in the
/// source, turn]`, in radians, the turns consistent along the ring and open to
/// a common multiple of 2π. An edge of no length in one of the rings turns
/// like the edge before it; where no edge has a length in both, all turn by
/// `otherwise`.
pub(super) fn turns(source: &[DVec2], target: &[DVec2], otherwise: f64) -> Vec<[f64; 2]> {
    let directions = [lifted(source), lifted(target)];
    let both = |k: usize| Some(directions[1][k]? - directions[0][k]?);
    let count = source.len();
    // The ring is closed: before the first edge comes the last.
    let known = (0..count).rev().find_map(both);
    let mut turn = known.unwrap_or(otherwise);
    (0..count)
        .map(|k| {
            turn = both(k).unwrap_or(turn);
            let back = directions[1][k].map(|angle| angle - turn);
            [directions[0][k].or(back).unwrap_or(0.0), turn]
        })
        .collect()
}

/// The whole turns, in radians, that bring an angle nearest to another.
pub(super) fn whole_turns(angle: f64, near: f64) -> f64 {
    TAU * ((near - angle) / TAU).round()
}

/// The direction of each edge that has a length, continuous along the ring.
fn lifted(ring: &[DVec2]) -> Vec<Option<f64>> {
    let steps: Vec<DVec2> = edges(ring).map(DVec2::normalize_or_zero).collect();
    let long: Vec<usize> = (0..steps.len())
        .filter(|&k| steps[k] != DVec2::ZERO)
        .collect();
    let mut angles = vec![None; ring.len()];
    let Some(&first) = long.first() else {
        return angles;
    };
    let next = long.iter().cycle().skip(1);
    let mut turning: Vec<f64> = long
        .iter()
        .zip(next)
        .map(|(&a, &b)| steps[a].angle_to(steps[b]))
        .collect();
    mend(&mut turning, ring);
    let mut angle = steps[first].to_angle();
    for (&k, turn) in long.iter().zip(turning) {
        angles[k] = Some(angle);
        angle += turn;
    }
    angles
}

/// Chooses the signs of half turns so that the ring turns once in all.
fn mend(turning: &mut [f64], ring: &[DVec2]) {
    let origin = ring.first().copied().unwrap_or_default();
    let twice_area: f64 = edges(ring)
        .zip(ring)
        .map(|(edge, &p)| (p - origin).perp_dot(edge))
        .sum();
    let wanted = TAU.copysign(twice_area);
    let mut missing = ((wanted - turning.iter().sum::<f64>()) / TAU).round();
    for turn in turning.iter_mut() {
        // Of all turning angles only half turns have two signs to choose from.
        let is_free = PI - turn.abs() < STRAIGHT_BACK && *turn * missing < 0.0;
        if is_free {
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
        let angles: Vec<f64> = lifted(ring).into_iter().flatten().collect();
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
    fn a_slit_turns_back_inwards_and_a_spike_outwards() {
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
    fn an_edge_of_no_length_turns_like_its_neighbour() {
        let source = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        let target = points(&[(0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (-1.0, 2.0)]);
        for [_, turn] in turns(&source, &target, 0.0).iter().take(2) {
            assert!((turn - PI / 2.0).abs() < 1e-12, "{turn}");
        }
        let nothing = vec![DVec2::ONE; 4];
        assert!(turns(&nothing, &target, 0.7).iter().all(|t| t[1] == 0.7));
    }
}
