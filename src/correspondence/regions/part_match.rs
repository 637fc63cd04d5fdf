//! One part matched with one part, holes and all.

use super::super::boundary_match::BoundaryMatch;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchError;
use super::closing::{FreeSpace, RingVertices, centre};
use super::matched_curves::MatchedCurves;
use super::part_matcher::{PartMatchTask, PartMatcher, PartPin};
use super::region_match::{PieceMatch, RegionMatchError, RingMatch};
use crate::geometry::{DVec2, Ring, Side};
use crate::work::progress::{Cancelled, still_wanted};
use rayon::prelude::*;

/// Longest edge of a shared outline, as a share of the outer one's length.
/// 80 edges around: fewer bend coarsely on the way, more cost the inside, which
/// grows with their square.
const SPACING: f64 = 0.0125;

/// A ring has at least so many vertices.
/// A small hole would be a triangle by the spacing of the whole.
const LEAST_VERTICES: f64 = 10.0;

/// Matches a part with a part.
pub(super) fn match_part(task: &PartMatchTask) -> Result<PieceMatch, RegionMatchError> {
    let mut sides = PartMatcher::new(task);
    let blunt = sides.outer_match()?;
    let (pairing, cuts) = sides.paired_and_cut(blunt.rotation())?;
    // The walks are others once they go around holes.
    let outer = if cuts.is_empty() {
        blunt
    } else {
        sides.outer_match()?
    };
    let mut rings = vec![sides.outer_ring(&outer)?];
    let holes = pairing.pairs.par_iter().map(|&pair| {
        still_wanted(task.progress)?;
        sides.hole_ring(pair, outer.rotation())
    });
    // All first: of several failures it is the first in order that is told.
    let holes: Vec<Result<RingMatch, RegionMatchError>> = holes.collect();
    for hole in holes {
        rings.push(hole?);
    }
    let closing = sides.closing_rings(&rings[0], &pairing.pairs, outer.rotation())?;
    let lone = if task.holes.leaves_alone() {
        closing
    } else {
        rings.extend(closing);
        Vec::new()
    };
    Ok(PieceMatch {
        rings,
        lone,
        source_part: Some(task.parts[0]),
        target_part: Some(task.parts[1]),
        cuts,
        rotation: outer.rotation(),
        cost: outer.cost(),
        notes: sides.notes,
    })
}

impl PartMatcher<'_> {
    fn outer_ring(&self, matched: &BoundaryMatch) -> Result<RingMatch, RegionMatchError> {
        let curves = self.curves()?;
        let slits = Side::BOTH.map(|side| self.walks[side].slits.clone());
        let course = MatchedCurves::new(curves, matched.clone(), spacing(1.0), slits);
        Ok(RingMatch::along(course))
    }

    /// Two holes that belong together. Where their form leaves the rotation
    /// open, they turn with their part.
    fn hole_ring(&self, [a, b]: [usize; 2], rotation: f64) -> Result<RingMatch, RegionMatchError> {
        let holes = [
            &self.task.regions[0].holes[a],
            &self.task.regions[1].holes[b],
        ];
        let curve = |ring: &Ring| BoundaryCurve::closed(ring).map_err(MatchError::from);
        let curves = [curve(holes[0])?, curve(holes[1])?];
        let turned = |ring: &Ring, by: f64| {
            let (turn, middle) = (DVec2::from_angle(by), centre(ring));
            curve(&ring.mapped(|p| turn.rotate(p - middle)))
        };
        // Half of the turn each, so that the way back is the same to the last bit.
        let posed = [
            turned(holes[0], 0.5 * rotation)?,
            turned(holes[1], -0.5 * rotation)?,
        ];
        let is_here = |pin: &PartPin| pin.rings == [a + 1, b + 1];
        let matched = self.matched(is_here, &curves, &posed)?;
        let share = |side: Side| holes[side].perimeter() / self.walks[side].ring.perimeter();
        let spacing = spacing(0.5 * (share(Side::Source) + share(Side::Target)));
        let course = MatchedCurves::new(curves, matched, spacing, [vec![], vec![]]);
        Ok(RingMatch::along(course))
    }

    /// What is alone and was not opened closes to a point.
    fn closing_rings(
        &self,
        around: &RingMatch,
        pairs: &[[usize; 2]],
        rotation: f64,
    ) -> Result<Vec<RingMatch>, Cancelled> {
        let mut rings = Vec::new();
        for side in Side::BOTH {
            let (numbers, holes) = self.closed_holes(side);
            if holes.len() == pairs.len() {
                continue;
            }
            let mut room = FreeSpace::of(self.task.regions[side.other()]);
            for (number, hole) in numbers.into_iter().zip(holes) {
                if pairs.iter().any(|pair| pair[side] == number) {
                    continue;
                }
                let (from, to) = (&around.source, &around.target);
                let (outer, turn) = match side {
                    Side::Source => (RingVertices { from, to }, rotation),
                    Side::Target => (RingVertices { from: to, to: from }, -rotation),
                };
                let hole = self.divided(side, hole);
                let point = room.point_ring(&hole, &outer, turn);
                let whole = hole.points().to_vec();
                rings.push(RingMatch::alone(side, whole, point));
                still_wanted(self.task.progress)?;
            }
        }
        Ok(rings)
    }

    /// The ring with its long edges divided.
    fn divided(&self, side: Side, ring: &Ring) -> Ring {
        let outer = self.walks[side].ring.perimeter();
        let longest = (SPACING * outer).min(ring.perimeter() / LEAST_VERTICES);
        let mut points = Vec::new();
        for (a, b) in ring.edges() {
            let pieces = (a.distance(b) / longest).ceil().clamp(1.0, 1e4) as u32;
            points.extend((0..pieces).map(|k| a.lerp(b, f64::from(k) / f64::from(pieces))));
        }
        Ring::new(points).unwrap_or_else(|_| ring.clone())
    }
}

/// How far apart vertices are on a ring that is `share` as long as the outer one.
fn spacing(share: f64) -> f64 {
    (SPACING / share).min(1.0 / LEAST_VERTICES)
}
