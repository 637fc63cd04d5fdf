//! Both parts on the way to being matched: which holes their walks go around
//! by now, and which pins lie on what.

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
use crate::work::progress::{Progress, still_wanted};

/// What it costs a match to close a hole, in its length over the outer one's.
/// For a hole as long as the outer boundary it is between what two poses of a
/// thing cost as matched, up to 0.3, and what unlike things do, 0.4 and more.
const CLOSING_PRICE: f64 = 0.35;

/// What is done with the holes of two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HolePolicy {
    /// They are paired, and what is left is treated by a rule.
    By(HoleRule),
    /// None of them is paired; all are alone.
    Unpaired,
}

impl HolePolicy {
    /// Whether a ring may be cut open.
    fn cuts(self) -> bool {
        matches!(self, Self::By(HoleRule::Auto | HoleRule::Cut))
    }

    /// Whether holes without a partner are no part of the piece.
    pub(super) fn leaves_alone(self) -> bool {
        matches!(self, Self::By(HoleRule::Alone) | Self::Unpaired)
    }
}

/// What was said of one part and its partner.
pub(super) struct PartMatchTask<'a> {
    /// Source and target.
    pub(super) regions: [&'a Region; 2],
    /// Their numbers.
    pub(super) parts: [usize; 2],
    /// Number and points of each pin on them.
    pub(super) pins: Vec<(usize, [DVec2; 2])>,
    /// Number of each cut through one of them.
    pub(super) cuts: Vec<(usize, RingCut)>,
    pub(super) holes: HolePolicy,
    pub(super) options: MatchOptions,
    pub(super) progress: &'a dyn Progress,
}

/// A pin with the rings it lies on.
pub(super) struct PartPin {
    pub(super) index: usize,
    /// In each design 0 for the outer one, 1 + k for hole k.
    pub(super) rings: [usize; 2],
    points: [DVec2; 2],
}

/// Both parts on the way to being matched.
pub(super) struct PartMatcher<'a> {
    pub(super) walks: [SlitBoundary; 2],
    /// For each side which of its holes the walk goes around by now.
    opened: [Vec<usize>; 2],
    pub(super) pins: Vec<PartPin>,
    /// What was not done as it was asked for.
    pub(super) notes: Vec<MatchNote>,
    pub(super) task: &'a PartMatchTask<'a>,
}

impl PartPin {
    /// Whether it ties a hole of one side to the outer ring across.
    fn is_across(&self, side: Side) -> bool {
        self.rings[side] > 0 && self.rings[side.other()] == 0
    }
}

impl<'a> PartMatcher<'a> {
    pub(super) fn new(task: &'a PartMatchTask<'a>) -> Self {
        let nearest = |side: Side, p: DVec2| {
            let distances = task.regions[side]
                .rings()
                .map(|ring| ring.distance_squared(p));
            let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.map_or(0, |(ring, _)| ring)
        };
        let pin = |&(index, points): &(usize, [DVec2; 2])| PartPin {
            index,
            rings: Side::BOTH.map(|side| nearest(side, points[side])),
            points,
        };
        Self {
            walks: task.regions.map(SlitBoundary::around),
            opened: [Vec::new(), Vec::new()],
            pins: task.pins.iter().map(pin).collect(),
            notes: Vec::new(),
            task,
        }
    }

    /// For each side the holes that a pin ties to the other's outer ring.
    fn pins_across(&self) -> Result<[Vec<usize>; 2], RegionMatchError> {
        let mut across = [Vec::new(), Vec::new()];
        for pin in &self.pins {
            let Some(side) = Side::BOTH.into_iter().find(|&side| pin.is_across(side)) else {
                continue;
            };
            if self.task.holes == HolePolicy::By(HoleRule::Close) {
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

    /// For each side the cuts that were asked for: number, hole, ends.
    fn asked_cuts(&self) -> [Vec<(usize, usize, [DVec2; 2])>; 2] {
        Side::BOTH.map(|side| {
            let region = self.task.regions[side];
            let here = self.task.cuts.iter().filter(|(_, cut)| cut.side == side);
            let mut asked: Vec<(usize, usize, [DVec2; 2])> = Vec::new();
            for &(number, cut) in here {
                let far = |ring: &Ring| ring.distance_squared(cut.hole);
                let holes = region.holes.iter().map(far).enumerate();
                let nearest = holes.min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((hole, _)) = nearest
                    && asked.iter().all(|other| other.1 != hole)
                {
                    asked.push((number, hole, [cut.outer, cut.hole]));
                }
            }
            asked
        })
    }

    /// Pairs the holes, and opens those that are to be, or had better be,
    /// gone around.
    pub(super) fn paired_and_cut(
        &mut self,
        rotation: f64,
    ) -> Result<(Pairing, Vec<RingCut>), RegionMatchError> {
        let across = self.pins_across()?;
        let asked = self.asked_cuts();
        let taken = Side::BOTH.map(|side| {
            let mut taken: Vec<usize> = across[side].clone();
            taken.extend(asked[side].iter().map(|&(_, hole, _)| hole));
            taken.sort_unstable();
            taken.dedup();
            taken
        });
        let [source, target] = self.task.regions;
        let fixed = self.pinned_holes(&taken);
        let taken = [&taken[0][..], &taken[1]];
        let pairing = match self.task.holes {
            HolePolicy::By(_) => pair_holes(source, target, rotation, &fixed, taken)?,
            // None but those that somebody pinned.
            HolePolicy::Unpaired => Pairing {
                pairs: fixed,
                ..Pairing::default()
            },
        };
        let mut cuts: Vec<(Side, [DVec2; 2])> = Vec::new();
        for side in Side::BOTH {
            for &(number, hole, ends) in &asked[side] {
                let slit = self.open_asked(side, hole, ends);
                cuts.push((side, slit.ok_or(RegionMatchError::Cut(number))?));
            }
            let alone = [&pairing.dying, &pairing.born][side];
            // Each cut changes the walk: the largest hole matters most to it.
            for hole in self.largest_first(side, alone) {
                let slit = self.open_if_better(side, hole, false);
                still_wanted(self.task.progress)?;
                cuts.extend(slit.map(|ends| (side, ends)));
            }
            for &hole in &across[side] {
                if !self.opened[side].contains(&hole) {
                    let slit = self.open_if_better(side, hole, true);
                    still_wanted(self.task.progress)?;
                    cuts.extend(slit.map(|ends| (side, ends)));
                }
            }
        }
        let cut = |(side, [outer, hole]): (Side, [DVec2; 2])| RingCut { side, outer, hole };
        Ok((pairing, cuts.into_iter().map(cut).collect()))
    }

    fn pinned_holes(&self, taken: &[Vec<usize>; 2]) -> Vec<[usize; 2]> {
        let mut fixed: Vec<[usize; 2]> = self
            .pins
            .iter()
            .filter(|pin| pin.rings[0] > 0 && pin.rings[1] > 0)
            .map(|pin| pin.rings.map(|ring| ring - 1))
            .filter(|pair| (0..2).all(|s| !taken[s].contains(&pair[s])))
            .collect();
        fixed.sort_unstable();
        fixed.dedup();
        fixed
    }

    fn largest_first(&self, side: Side, holes: &[usize]) -> Vec<usize> {
        let area = |hole: usize| self.task.regions[side].holes[hole].signed_area();
        let mut holes = holes.to_vec();
        holes.sort_by(|&a, &b| area(a).total_cmp(&area(b))); // clockwise: negative
        holes
    }

    /// The holes that the walk does not go around, with their numbers.
    pub(super) fn closed_holes(&self, side: Side) -> (Vec<usize>, Vec<&'a Ring>) {
        let holes = self.task.regions[side].holes.iter().enumerate();
        let closed = holes.filter(|(k, _)| !self.opened[side].contains(k));
        closed.unzip()
    }

    fn open_asked(&mut self, side: Side, hole: usize, ends: [DVec2; 2]) -> Option<[DVec2; 2]> {
        let (numbers, holes) = self.closed_holes(side);
        let at = numbers.iter().position(|&k| k == hole)?;
        let slit = self.walks[side].slit(&holes, at, ends[0], ends[1])?;
        self.walks[side] = self.walks[side].opened(holes[at], &slit)?;
        self.opened[side].push(hole);
        Some(slit.ends)
    }

    /// Opens a hole where the rules say so, or where that matches better than
    /// closing it.
    fn open_if_better(&mut self, side: Side, hole: usize, forced: bool) -> Option<[DVec2; 2]> {
        let rule = self.task.holes;
        if !rule.cuts() && !forced {
            return None;
        }
        let (numbers, holes) = self.closed_holes(side);
        let at = numbers.iter().position(|&k| k == hole)?;
        // Both walks were measured when they were matched as they are.
        let other = self.walks[side.other()].curve().ok()?;
        let (options, progress) = (&self.along_boundary(), self.task.progress);
        let best = ring_cut::best_cut(&self.walks[side], &holes, at, &other, options, progress);
        let Some(opened) = best else {
            self.tell_uncut(side, hole, forced);
            return None;
        };
        // Both costs are of coarse matches, so that they compare.
        if rule == HolePolicy::By(HoleRule::Auto) && !forced {
            let blunt = self.coarse_cost(side, &other)?;
            let share = holes[at].perimeter() / self.walks[side].ring.perimeter();
            if blunt + CLOSING_PRICE * share <= opened.cost {
                return None;
            }
        }
        self.walks[side] = opened.walk;
        self.opened[side].push(hole);
        Some(opened.slit.ends)
    }

    /// Notes that a hole closes although it was to be cut open, and which pin
    /// that leaves out.
    fn tell_uncut(&mut self, side: Side, hole: usize, forced: bool) {
        let part = self.task.parts[side];
        if forced || self.task.holes == HolePolicy::By(HoleRule::Cut) {
            self.notes.push(MatchNote::Uncut { side, part, hole });
        }
        let lost = |pin: &&PartPin| forced && pin.is_across(side) && pin.rings[side] == hole + 1;
        let pins = self.pins.iter().filter(lost).map(|pin| pin.index);
        self.notes.extend(pins.map(MatchNote::PinLeftOut));
    }

    /// How matches that are many are tried: by the boundary alone.
    fn along_boundary(&self) -> MatchOptions {
        MatchOptions {
            inner: 0.0,
            ..self.task.options.clone()
        }
    }

    fn coarse_cost(&self, side: Side, other: &BoundaryCurve) -> Option<f64> {
        let curve = self.walks[side].curve().ok()?;
        let coarse = ring_cut::coarse_options(&self.along_boundary());
        let matched = match_curves(&curve, other, &[], &coarse).ok()?;
        Some(matched.cost())
    }

    pub(super) fn curves(&self) -> Result<[BoundaryCurve; 2], RegionMatchError> {
        let curve = |side: Side| self.walks[side].curve().map_err(MatchError::from);
        Ok([curve(Side::Source)?, curve(Side::Target)?])
    }

    /// The match of the walks as they are now.
    pub(super) fn outer_match(&self) -> Result<BoundaryMatch, RegionMatchError> {
        let curves = self.curves()?;
        let is_outer =
            |side: Side, ring: usize| ring == 0 || self.opened[side].contains(&(ring - 1));
        let is_here =
            |pin: &PartPin| (Side::BOTH.into_iter()).all(|side| is_outer(side, pin.rings[side]));
        self.matched(is_here, &curves, &curves)
    }

    /// Matches two curves with some of the pins on them as they lie, and names
    /// pins by their numbers among all.
    pub(super) fn matched(
        &self,
        is_here: impl Fn(&PartPin) -> bool,
        lying: &[BoundaryCurve; 2],
        [source, target]: &[BoundaryCurve; 2],
    ) -> Result<BoundaryMatch, RegionMatchError> {
        let pins: Vec<&PartPin> = self.pins.iter().filter(|pin| is_here(pin)).collect();
        let place = |pin: &&PartPin| Pin::of(|side| lying[side].nearest(pin.points[side]));
        let places: Vec<Pin> = pins.iter().map(place).collect();
        let number = |k: usize| pins.get(k).map_or(k, |pin| pin.index);
        let matched = match_curves(source, target, &places, &self.task.options);
        matched.map_err(|error| match error {
            MatchError::Pins(error) => RegionMatchError::Pins(renumbered(error, number)),
            error => RegionMatchError::Match(error),
        })
    }
}

fn renumbered(error: PinError, number: impl Fn(usize) -> usize) -> PinError {
    match error {
        PinError::NotFinite(k) => PinError::NotFinite(number(k)),
        PinError::SamePoint(a, b) => PinError::SamePoint(number(a), number(b)),
        PinError::Crossing(a, b) => PinError::Crossing(number(a), number(b)),
    }
}
