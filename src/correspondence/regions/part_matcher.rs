//! Matches one part with another. [`PartMatcher`] decides which holes are paired, cut open or
//! closed, and matches the resulting outer boundaries.

use super::super::boundary::match_curves;
use super::super::boundary_match::BoundaryMatch;
use super::super::curve::BoundaryCurve;
use super::super::options::{MatchError, MatchOptions};
use super::super::pairing::{Pairing, pair_holes};
use super::super::pins::{Pin, PinError};
use super::super::{HoleRule, RingCut};
use super::region_match::{MatchNote, RegionMatchError};
use super::ring_cut;
use super::slit_boundary::SlitBoundary;
use crate::geometry::{DVec2, Region, Ring, Side};
use crate::work::progress::{Progress, check_cancelled};

/// Cost of closing a hole whose perimeter equals that of the outer boundary; the cost is
/// proportional to the hole's perimeter. The value lies between the match costs of two poses of one
/// shape (up to 0.3) and of dissimilar shapes (0.4 and more) (heuristic).
const CLOSING_COST: f64 = 0.35;

/// Treatment of the holes of two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HolePolicy {
    /// Holes are paired; those without a partner are treated by the given rule.
    Paired(HoleRule),
    /// Holes are paired only by pins; all other holes are unmatched and excluded from the matched
    /// piece.
    Unpaired,
}

impl HolePolicy {
    /// Returns whether the policy allows cutting a part open at a hole without a request by the
    /// user.
    fn cuts(self) -> bool {
        matches!(self, Self::Paired(HoleRule::Auto | HoleRule::Cut))
    }

    /// Returns whether unmatched holes are excluded from the matched piece.
    pub(super) fn leaves_transient(self) -> bool {
        matches!(self, Self::Paired(HoleRule::Transient) | Self::Unpaired)
    }
}

/// A part of the source and a part of the target to match, with the settings that apply to them.
pub(super) struct PartMatchTask<'a> {
    /// The two parts, source and target.
    pub(super) regions: [&'a Region; 2],
    /// Indices of the two parts in their designs, source first.
    pub(super) parts: [usize; 2],
    /// For each pin on these parts: its index among all pins, and its points in source and target.
    pub(super) pins: Vec<(usize, [DVec2; 2])>,
    /// For each cut through one of these parts: its index among all cuts, and the cut.
    pub(super) cuts: Vec<(usize, RingCut)>,
    pub(super) holes: HolePolicy,
    pub(super) options: MatchOptions,
    pub(super) progress: &'a dyn Progress,
}

/// A pin with the rings on which its two points lie.
pub(super) struct PartPin {
    /// Index among all pins.
    pub(super) index: usize,
    /// Ring of the part in each design: 0 for the outer ring, 1 + k for hole k.
    pub(super) rings: [usize; 2],
    points: [DVec2; 2],
}

/// Two parts that are being matched: their boundary loops with the slits cut so far, and their
/// pins.
pub(super) struct PartMatcher<'a> {
    /// Outer boundary loops of both parts, including the slits cut so far.
    pub(super) boundaries: [SlitBoundary; 2],
    /// For each design: indices of the holes that were cut open, so that the boundary loop runs
    /// around them.
    cut_holes: [Vec<usize>; 2],
    pub(super) pins: Vec<PartPin>,
    /// Notes about requests that could not be fulfilled.
    pub(super) notes: Vec<MatchNote>,
    pub(super) task: &'a PartMatchTask<'a>,
}

impl PartPin {
    /// Returns whether the pin ties a hole of the design `side` to the outer ring of the other
    /// design.
    fn is_across(&self, side: Side) -> bool {
        self.rings[side] > 0 && self.rings[side.other()] == 0
    }
}

impl<'a> PartMatcher<'a> {
    /// Starts with the outer boundaries, without slits, and locates the pins.
    pub(super) fn new(task: &'a PartMatchTask<'a>) -> Self {
        let nearest = |side: Side, p: DVec2| {
            let distances = task.regions[side]
                .rings()
                .map(|ring| ring.distance_squared(p));
            let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.map_or(0, |(ring, _)| ring)
        };
        let located = |&(index, points): &(usize, [DVec2; 2])| PartPin {
            index,
            rings: Side::BOTH.map(|side| nearest(side, points[side])),
            points,
        };
        Self {
            boundaries: task.regions.map(SlitBoundary::of_region),
            cut_holes: [Vec::new(), Vec::new()],
            pins: task.pins.iter().map(located).collect(),
            notes: Vec::new(),
            task,
        }
    }

    /// Returns for each design the holes that a pin ties to the other design's outer ring,
    /// ascending.
    ///
    /// # Errors
    /// [`RegionMatchError::PinAcross`] if there is such a hole, but the rule is that unmatched
    /// holes close.
    fn pins_across(&self) -> Result<[Vec<usize>; 2], RegionMatchError> {
        let mut across = [Vec::new(), Vec::new()];
        for pin in &self.pins {
            let Some(side) = Side::BOTH.into_iter().find(|&side| pin.is_across(side)) else {
                continue;
            };
            if self.task.holes == HolePolicy::Paired(HoleRule::Close) {
                return Err(RegionMatchError::PinAcross(pin.index));
            }
            across[side].push(pin.rings[side] - 1);
        }
        for holes in &mut across {
            holes.sort_unstable();
            holes.dedup();
        }
        Ok(across)
    }

    /// Returns for each design the cuts that the user requested. Each has the index of the cut, the
    /// index of the hole, and the two ends of the cut, the outer one first. Each hole is cut at
    /// most once.
    fn requested_cuts(&self) -> [Vec<(usize, usize, [DVec2; 2])>; 2] {
        Side::BOTH.map(|side| {
            let region = self.task.regions[side];
            let on_side = self.task.cuts.iter().filter(|(_, cut)| cut.side == side);
            let mut requested: Vec<(usize, usize, [DVec2; 2])> = Vec::new();
            for &(number, cut) in on_side {
                let distance = |ring: &Ring| ring.distance_squared(cut.hole);
                let holes = region.holes.iter().map(distance).enumerate();
                let nearest = holes.min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((hole, _)) = nearest
                    && requested.iter().all(|other| other.1 != hole)
                {
                    requested.push((number, hole, [cut.outer, cut.hole]));
                }
            }
            requested
        })
    }

    /// Pairs the holes. Cuts a part open at an unmatched hole where that is requested or matches
    /// better than closing the hole. Returns the pairs and the cuts made. `rotation` is that of the
    /// outer boundaries' match, in radians.
    ///
    /// # Errors
    /// [`RegionMatchError`] for pins or cuts that cannot be satisfied, or if the work is cancelled.
    pub(super) fn pair_and_cut_holes(
        &mut self,
        rotation: f64,
    ) -> Result<(Pairing, Vec<RingCut>), RegionMatchError> {
        let across = self.pins_across()?;
        let requested = self.requested_cuts();
        let used_holes = Side::BOTH.map(|side| {
            let mut used_holes: Vec<usize> = across[side].clone();
            used_holes.extend(requested[side].iter().map(|&(_, hole, _)| hole));
            used_holes.sort_unstable();
            used_holes.dedup();
            used_holes
        });
        let [source, target] = self.task.regions;
        let fixed = self.pinned_holes(&used_holes);
        let used_holes = [&used_holes[0][..], &used_holes[1]];
        let pairing = match self.task.holes {
            HolePolicy::Paired(_) => pair_holes(source, target, rotation, &fixed, used_holes)?,
            // Only holes that pins tie together are paired.
            HolePolicy::Unpaired => Pairing {
                pairs: fixed,
                ..Pairing::default()
            },
        };
        let mut cuts: Vec<(Side, [DVec2; 2])> = Vec::new();
        for side in Side::BOTH {
            for &(number, hole, ends) in &requested[side] {
                let slit = self.open_requested(side, hole, ends);
                cuts.push((side, slit.ok_or(RegionMatchError::Cut(number))?));
            }
            let unmatched = [&pairing.source_only, &pairing.target_only][side];
            // Each cut changes the boundary loop, so begin with the largest hole, which matters
            // most.
            for hole in self.sorted_by_area(side, unmatched) {
                let slit = self.open_if_better(side, hole, false);
                check_cancelled(self.task.progress)?;
                cuts.extend(slit.map(|ends| (side, ends)));
            }
            for &hole in &across[side] {
                if !self.cut_holes[side].contains(&hole) {
                    let slit = self.open_if_better(side, hole, true);
                    check_cancelled(self.task.progress)?;
                    cuts.extend(slit.map(|ends| (side, ends)));
                }
            }
        }
        let cut = |(side, [outer, hole]): (Side, [DVec2; 2])| RingCut { side, outer, hole };
        Ok((pairing, cuts.into_iter().map(cut).collect()))
    }

    /// Returns the pairs of holes that pins tie together, except pairs with a hole in `used_holes`.
    fn pinned_holes(&self, used_holes: &[Vec<usize>; 2]) -> Vec<[usize; 2]> {
        let mut fixed: Vec<[usize; 2]> = self
            .pins
            .iter()
            .filter(|pin| pin.rings[0] > 0 && pin.rings[1] > 0)
            .map(|pin| pin.rings.map(|ring| ring - 1))
            .filter(|pair| (0..2).all(|s| !used_holes[s].contains(&pair[s])))
            .collect();
        fixed.sort_unstable();
        fixed.dedup();
        fixed
    }

    /// Returns the holes sorted by area, largest first.
    fn sorted_by_area(&self, side: Side, holes: &[usize]) -> Vec<usize> {
        let area = |hole: usize| self.task.regions[side].holes[hole].signed_area();
        let mut holes = holes.to_vec();
        // Holes are clockwise, so their areas are negative.
        holes.sort_by(|&a, &b| area(a).total_cmp(&area(b)));
        holes
    }

    /// Returns the indices of the holes that are not cut open, and these holes.
    pub(super) fn closed_holes(&self, side: Side) -> (Vec<usize>, Vec<&'a Ring>) {
        let holes = self.task.regions[side].holes.iter().enumerate();
        let closed = holes.filter(|(k, _)| !self.cut_holes[side].contains(k));
        closed.unzip()
    }

    /// Cuts a hole open near the requested ends. Returns the ends of the slit, or `None` if no such
    /// slit is possible.
    fn open_requested(&mut self, side: Side, hole: usize, ends: [DVec2; 2]) -> Option<[DVec2; 2]> {
        let (numbers, holes) = self.closed_holes(side);
        let index = numbers.iter().position(|&k| k == hole)?;
        let slit = self.boundaries[side].slit(&holes, index, ends[0], ends[1])?;
        self.boundaries[side] = self.boundaries[side].cut_open(holes[index], &slit)?;
        self.cut_holes[side].push(hole);
        Some(slit.ends)
    }

    /// Cuts a hole open if the rule demands it, if a pin does (`forced`), or if that matches better
    /// than closing the hole. Returns the ends of the slit if the hole was cut open.
    fn open_if_better(&mut self, side: Side, hole: usize, forced: bool) -> Option<[DVec2; 2]> {
        let rule = self.task.holes;
        if !rule.cuts() && !forced {
            return None;
        }
        let (numbers, holes) = self.closed_holes(side);
        let index = numbers.iter().position(|&k| k == hole)?;
        // Lengths were already checked when the boundaries were matched, so this succeeds.
        let other = self.boundaries[side.other()].curve().ok()?;
        let (options, progress) = (&self.along_boundary(), self.task.progress);
        let found = ring_cut::best_cut(
            &self.boundaries[side],
            &holes,
            index,
            &other,
            options,
            progress,
        );
        let Some(candidate) = found else {
            self.note_uncut(side, hole, forced);
            return None;
        };
        // Both costs come from coarse matches, so they are comparable.
        if rule == HolePolicy::Paired(HoleRule::Auto) && !forced {
            let closed_cost = self.coarse_cost(side, &other)?;
            let length_ratio = holes[index].perimeter() / self.boundaries[side].ring.perimeter();
            if closed_cost + CLOSING_COST * length_ratio <= candidate.cost {
                return None;
            }
        }
        self.boundaries[side] = candidate.boundary;
        self.cut_holes[side].push(hole);
        Some(candidate.slit.ends)
    }

    /// Adds a note if a hole closes although the rule or a pin demands that it is cut open, and a
    /// note for each pin that is ignored because the hole closes.
    fn note_uncut(&mut self, side: Side, hole: usize, forced: bool) {
        let part = self.task.parts[side];
        if forced || self.task.holes == HolePolicy::Paired(HoleRule::Cut) {
            self.notes.push(MatchNote::Uncut { side, part, hole });
        }
        let is_lost = |pin: &&PartPin| forced && pin.is_across(side) && pin.rings[side] == hole + 1;
        let pins = self.pins.iter().filter(is_lost).map(|pin| pin.index);
        self.notes.extend(pins.map(MatchNote::PinLeftOut));
    }

    /// Returns the options for trial matches: without inner distances, which would take longer.
    fn along_boundary(&self) -> MatchOptions {
        MatchOptions {
            inner: 0.0,
            ..self.task.options.clone()
        }
    }

    /// Returns the cost of a coarse match of one design's boundary loop with the curve `other`.
    fn coarse_cost(&self, side: Side, other: &BoundaryCurve) -> Option<f64> {
        let curve = self.boundaries[side].curve().ok()?;
        let coarse = ring_cut::coarse_options(&self.along_boundary());
        let matched = match_curves(&curve, other, &[], &coarse).ok()?;
        Some(matched.cost())
    }

    /// Returns the curves along both boundary loops.
    pub(super) fn curves(&self) -> Result<[BoundaryCurve; 2], RegionMatchError> {
        let curve = |side: Side| self.boundaries[side].curve().map_err(MatchError::from);
        Ok([curve(Side::Source)?, curve(Side::Target)?])
    }

    /// Matches the outer boundary loops, including the slits cut so far, with all pins on them.
    pub(super) fn outer_match(&self) -> Result<BoundaryMatch, RegionMatchError> {
        let curves = self.curves()?;
        let is_outer =
            |side: Side, ring: usize| ring == 0 || self.cut_holes[side].contains(&(ring - 1));
        let is_on_both =
            |pin: &PartPin| (Side::BOTH.into_iter()).all(|side| is_outer(side, pin.rings[side]));
        self.match_with_pins(is_on_both, &curves, &curves)
    }

    /// Matches the curves `source` and `target` with the pins that satisfy `is_here`. The two
    /// curves may be rotated copies of the curves `located`, on which the places of the pins are
    /// found. Errors refer to pins by their indices among all pins.
    pub(super) fn match_with_pins(
        &self,
        is_here: impl Fn(&PartPin) -> bool,
        located: &[BoundaryCurve; 2],
        [source, target]: &[BoundaryCurve; 2],
    ) -> Result<BoundaryMatch, RegionMatchError> {
        let pins: Vec<&PartPin> = self.pins.iter().filter(|pin| is_here(pin)).collect();
        let place = |pin: &&PartPin| Pin::from_fn(|side| located[side].nearest(pin.points[side]));
        let places: Vec<Pin> = pins.iter().map(place).collect();
        let index_of = |k: usize| pins.get(k).map_or(k, |pin| pin.index);
        let matched = match_curves(source, target, &places, &self.task.options);
        matched.map_err(|error| match error {
            MatchError::Pins(error) => RegionMatchError::Pins(renumber_pins(error, index_of)),
            error => RegionMatchError::Match(error),
        })
    }
}

/// Replaces the pin indices in an error, which count the pins of one match, with indices among all
/// pins.
fn renumber_pins(error: PinError, index_of: impl Fn(usize) -> usize) -> PinError {
    match error {
        PinError::NotFinite(k) => PinError::NotFinite(index_of(k)),
        PinError::SamePoint(a, b) => PinError::SamePoint(index_of(a), index_of(b)),
        PinError::Crossing(a, b) => PinError::Crossing(index_of(a), index_of(b)),
    }
}
