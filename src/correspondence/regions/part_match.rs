//! Matches one part of the source with one part of the target, including holes and cuts. The result
//! is a [`PieceMatch`].

use super::super::boundary_match::BoundaryMatch;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchError;
use super::closing::{FreeSpace, RingVertices, outline_centre};
use super::matched_curves::MatchedCurves;
use super::part_matcher::{PartMatchTask, PartMatcher, PartPin};
use super::region_match::{PieceMatch, RegionMatchError, RingMatch};
use crate::geometry::{DVec2, Ring, Side};
use crate::work::progress::{Cancelled, check_cancelled};
use rayon::prelude::*;

/// Maximum edge length of matched rings, as a fraction of the outer ring's length: at least 80
/// edges around. Fewer edges would bend coarsely; more edges cost time, because the number of
/// triangles inside grows with the square of this number (heuristic).
const MAX_EDGE: f64 = 0.0125;

/// Minimum number of vertices of a ring. [`MAX_EDGE`] alone would turn a small hole into a triangle
/// (heuristic).
const MIN_VERTICES: f64 = 10.0;

/// Matches a part of the source with a part of the target.
///
/// # Errors
/// [`RegionMatchError`] for pins or cuts that cannot be satisfied, or if the work is cancelled.
pub(super) fn match_part(task: &PartMatchTask) -> Result<PieceMatch, RegionMatchError> {
    let mut matcher = PartMatcher::new(task);
    let uncut = matcher.outer_match()?;
    let (pairing, cuts) = matcher.pair_and_cut_holes(uncut.rotation())?;
    // Cuts change the boundary loops, so these are matched again.
    let outer = if cuts.is_empty() {
        uncut
    } else {
        matcher.outer_match()?
    };
    let mut rings = vec![matcher.outer_ring(&outer)?];
    let holes = pairing.pairs.par_iter().map(|&pair| {
        check_cancelled(task.progress)?;
        matcher.hole_ring(pair, outer.rotation())
    });
    // Collect all results first, so that the reported error does not depend on the order of
    // completion.
    let holes: Vec<Result<RingMatch, RegionMatchError>> = holes.collect();
    for hole in holes {
        rings.push(hole?);
    }
    let closing = matcher.closing_rings(&rings[0], &pairing.pairs, outer.rotation())?;
    let transient = if task.holes.leaves_transient() {
        closing
    } else {
        rings.extend(closing);
        Vec::new()
    };
    Ok(PieceMatch {
        rings,
        lone: transient,
        source_part: Some(task.parts[0]),
        target_part: Some(task.parts[1]),
        cuts,
        rotation: outer.rotation(),
        cost: outer.cost(),
        notes: matcher.notes,
    })
}

impl PartMatcher<'_> {
    /// Returns the matched outer ring with shared vertices.
    fn outer_ring(&self, matched: &BoundaryMatch) -> Result<RingMatch, RegionMatchError> {
        let curves = self.curves()?;
        let slits = Side::BOTH.map(|side| self.boundaries[side].slits.clone());
        let (curves, polygons) = MatchedCurves::new(curves, matched.clone(), spacing(1.0), slits);
        Ok(RingMatch::from_curves(curves, polygons))
    }

    /// Matches two paired holes. They are first rotated like their parts, by `rotation` radians, so
    /// that holes whose shape determines no rotation, such as circles, follow their parts.
    fn hole_ring(&self, [a, b]: [usize; 2], rotation: f64) -> Result<RingMatch, RegionMatchError> {
        let holes = [
            &self.task.regions[0].holes[a],
            &self.task.regions[1].holes[b],
        ];
        let curve = |ring: &Ring| BoundaryCurve::closed(ring).map_err(MatchError::from);
        let curves = [curve(holes[0])?, curve(holes[1])?];
        let turned = |ring: &Ring, by: f64| {
            let (turn, middle) = (DVec2::from_angle(by), outline_centre(ring));
            curve(&ring.mapped(|p| turn.rotate(p - middle)))
        };
        // Rotate the hole of each design by half the angle, so that the reverse match is exactly
        // the inverse.
        let posed = [
            turned(holes[0], 0.5 * rotation)?,
            turned(holes[1], -0.5 * rotation)?,
        ];
        let is_here = |pin: &PartPin| pin.rings == [a + 1, b + 1];
        let matched = self.match_with_pins(is_here, &curves, &posed)?;
        let [a, b] =
            Side::BOTH.map(|side| holes[side].perimeter() / self.boundaries[side].ring.perimeter());
        let spacing = spacing(0.5 * (a + b));
        let (curves, polygons) = MatchedCurves::new(curves, matched, spacing, [vec![], vec![]]);
        Ok(RingMatch::from_curves(curves, polygons))
    }

    /// Returns a ring for each unmatched hole that was not cut open. The ring closes to a point, or
    /// opens from one. `around` is the matched outer ring.
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
            // Holes close in the part of the other design.
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
                let hole = self.subdivide_ring(side, hole);
                let point = room.point_ring(&hole, &outer, turn);
                let whole = hole.points().to_vec();
                rings.push(RingMatch::transient(side, whole, point));
                check_cancelled(self.task.progress)?;
            }
        }
        Ok(rings)
    }

    /// Returns a hole's ring with long edges divided into equal parts, so that the ring meets the
    /// limits [`MAX_EDGE`] and [`MIN_VERTICES`].
    fn subdivide_ring(&self, side: Side, ring: &Ring) -> Ring {
        let outer = self.boundaries[side].ring.perimeter();
        let longest = (MAX_EDGE * outer).min(ring.perimeter() / MIN_VERTICES);
        let mut points = Vec::new();
        for (a, b) in ring.edges() {
            let count = (a.distance(b) / longest).ceil().clamp(1.0, 1e4) as u32;
            points.extend((0..count).map(|k| a.lerp(b, f64::from(k) / f64::from(count))));
        }
        Ring::new(points).unwrap_or_else(|_| ring.clone())
    }
}

/// Returns the maximum edge length of a ring, as a fraction of the ring's own length.
/// `relative_length` is the ratio of the ring's length to the outer ring's length.
fn spacing(relative_length: f64) -> f64 {
    (MAX_EDGE / relative_length).min(1.0 / MIN_VERTICES)
}
