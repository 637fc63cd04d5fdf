//! Reduces the boundary points before the guaranteed base is built, by an advancing front that
//! starts on the boundary and moves inwards in both designs at once.
//!
//! A stretch of the front that sees a common point in each design is replaced by two edges to that
//! point, and the triangles in between join the mesh. A corner that can be cut off in both designs
//! is cut off. Each step is checked exactly in both designs and skipped if it does not fit, so the
//! remaining front always bounds corresponding pieces. Where the boundary has detail, each turn
//! halves the number of points; the final number is not guaranteed.

use super::advancing_front::{AdvancingFront, FrontRing};
use super::boundary_rings::BoundaryRings;
use super::chords::coincident_corners;
use crate::work::progress::{Cancelled, Progress};
use std::collections::HashSet;

/// The front stops when a turn removes less than this fraction of its points (heuristic).
const MIN_GAIN: f64 = 0.02;
/// Maximum number of turns (derived: at the smallest accepted gain, 0.98⁴⁰ of the points remain,
/// less than half).
const MAX_TURNS: usize = 40;

/// Moves the front inwards until it has at most `max_size` points or makes no more progress.
pub(super) fn coarsen(
    source: &BoundaryRings,
    target: &BoundaryRings,
    max_size: usize,
    progress: &dyn Progress,
) -> Result<AdvancingFront, Cancelled> {
    let mut coarse = AdvancingFront::of(source, target);
    // Corners on slits stay: the banks lie on each other, so a sight line from one touches both.
    let frozen: HashSet<u32> = coarse
        .points
        .iter()
        .flat_map(|p| coincident_corners(p))
        .collect();
    for turn in 0..MAX_TURNS {
        let before = coarse.size();
        for r in 0..coarse.rings.len() {
            FrontRing::of(&mut coarse, r, &frozen).advance(turn, progress)?;
        }
        let size = coarse.size();
        if size <= max_size || (before - size) as f64 <= MIN_GAIN * before as f64 {
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
            assert_eq!(boundary_rings::check(&coarse.front_rings(d), side), Ok(()));
            for face in &coarse.faces {
                assert!(face_cost::is_positive(
                    face.map(|v| coarse.points[d][v as usize])
                ));
            }
        }
    }
}
