//! Fewer boundary points for the guaranteed base: a front that starts on the
//! boundary and moves inwards in both designs at once.
//!
//! A stretch of the front that sees a common point in either design becomes
//! two edges to that point, and the faces between are the mesh's; a corner
//! that can be cut off in both designs is. Each step is checked exactly in
//! both designs and left out where it does not fit, so that what remains
//! bounds corresponding pieces again. It halves the number of points at each
//! turn where the boundary has detail; how far it comes is not promised.

use super::advancing_front::{AdvancingFront, FrontRing};
use super::boundary_rings::BoundaryRings;
use super::chords::coincident_corners;
use crate::work::progress::{Cancelled, Progress};
use std::collections::HashSet;

/// Turns of the front stop when fewer points than this share go: at each turn
/// every sight line is held against every edge.
const WORTHWHILE: f64 = 0.02;
/// Most turns: at the slowest that is worthwhile, 0.98⁴⁰ of the points are
/// left, less than half.
const TURNS: usize = 40;

/// Moves the front inwards until it has at most `enough` points or gets
/// stuck.
pub(super) fn coarsen(
    source: &BoundaryRings,
    target: &BoundaryRings,
    enough: usize,
    progress: &dyn Progress,
) -> Result<AdvancingFront, Cancelled> {
    let mut coarse = AdvancingFront::of(source, target);
    // Corners of slits stay: one bank lies on the other, and a sight line from
    // either would touch both.
    let kept: HashSet<u32> = coarse
        .points
        .iter()
        .flat_map(|p| coincident_corners(p))
        .collect();
    for turn in 0..TURNS {
        let before = coarse.size();
        for r in 0..coarse.rings.len() {
            FrontRing::of(&mut coarse, r, &kept).advance(turn, progress)?;
        }
        let size = coarse.size();
        if size <= enough || (before - size) as f64 <= WORTHWHILE * before as f64 {
            break;
        }
    }
    Ok(coarse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::polygons::{boundary_rings, face_cost};
    use crate::geometry::{DVec2, Side};
    use crate::work::progress::Silent;
    use std::f64::consts::TAU;

    #[test]
    fn the_front_leaves_a_coarse_piece_and_positive_faces() {
        let wave = |lobes: f64| -> Vec<DVec2> {
            let at = |k: u32| {
                let angle = TAU * f64::from(k) / 600.0;
                (2.0 + (lobes * angle).sin()) * DVec2::from_angle(angle)
            };
            (0..600).map(at).collect()
        };
        let hole = |r: f64| -> Vec<DVec2> {
            let at = |k: u32| r * DVec2::from_angle(-TAU * f64::from(k) / 100.0);
            (0..100).map(at).collect()
        };
        let source = BoundaryRings::of(&[wave(5.0), hole(0.3)]);
        let target = BoundaryRings::of(&[wave(3.0), hole(0.5)]);
        let coarse = coarsen(&source, &target, 60, &Silent).expect("not cancelled");
        assert!(coarse.size() < 200, "{}", coarse.size());
        for (d, side) in Side::BOTH.into_iter().enumerate() {
            assert_eq!(boundary_rings::check(&coarse.core(d), side), Ok(()));
            for face in &coarse.faces {
                assert!(face_cost::is_positive(
                    face.map(|v| coarse.points[d][v as usize])
                ));
            }
        }
    }
}
