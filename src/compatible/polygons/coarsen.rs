//! Coarsening: replaces the boundary of a piece by one with fewer points before the base mesh is
//! built ([`super::bridges`]). An advancing front starts on the boundary and moves inwards in both
//! designs at once.
//!
//! A stretch of the front is replaced by two edges to a new point if, in each design, a point
//! exists that sees the whole stretch; the triangles in between become faces of the mesh. A corner
//! is cut off if that is possible in both designs. Each step is checked exactly in both designs and
//! skipped if it does not fit. The remaining front therefore always bounds corresponding pieces.
//! How many points remain is not guaranteed.

use super::advancing_front::{AdvancingFront, FrontRing};
use super::boundary_rings::BoundaryRings;
use super::chords::coincident_corners;
use crate::work::progress::{Cancelled, Progress};
use std::collections::HashSet;

/// Minimum fraction of the front's points that a turn (one pass along the whole front) must remove
/// for the front to advance further (heuristic).
const MIN_GAIN: f64 = 0.02;
/// Maximum number of turns (derived: at the smallest accepted gain, 0.98⁴⁰ of the points remain,
/// less than half).
const MAX_TURNS: usize = 40;

/// Moves the front inwards until it has at most `max_size` points, or until a turn (one pass along
/// the whole front) removes too few points.
pub(super) fn coarsen(
    source: &BoundaryRings,
    target: &BoundaryRings,
    max_size: usize,
    progress: &dyn Progress,
) -> Result<AdvancingFront, Cancelled> {
    let mut coarse = AdvancingFront::of(source, target);
    // Corners on slits stay on the front. The two banks of a slit lie on each other, so a sight
    // line from one bank would touch both.
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
            assert_eq!(
                boundary_rings::validate_rings(&coarse.front_rings(d), side),
                Ok(())
            );
            for face in &coarse.faces {
                assert!(face_cost::is_positive(
                    face.map(|v| coarse.points[d][v as usize])
                ));
            }
        }
    }
}
