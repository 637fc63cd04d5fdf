//! Two designs on the way to being matched: all that is settled before the
//! prices of a match are, so that several matches share it.

use super::super::{MatchOptions, MatchSettings, RingCut};
use super::closing::{centre, shrunk};
use super::groups::{PartGroup, fixed_pairs, grouped};
use super::locate;
use super::locate::{LocatedPin, nearest_ring};
use super::many_rings;
use super::part_match::match_part;
use super::part_matcher::{HolePolicy, PartMatchTask};
use super::region_match::{
    MatchNote, POINT_SIZE, PieceMatch, RegionMatch, RegionMatchError, RingMatch,
};
use super::split::split;
use crate::correspondence::looks::PartLooks;
use crate::geometry::{DVec2, Region, Regions, Ring, Side, SourceTarget};
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, checkpoint, still_wanted};
use rayon::prelude::*;

/// How much of the work is done once parts are paired and split, as it is told.
const PREPARED: f64 = 0.2;

/// Two designs with their parts in groups, and split where they are to be.
#[derive(Clone)]
pub(crate) struct MatchPlan<'a> {
    pub(super) designs: [&'a Regions; 2],
    looks: &'a PartLooks,
    pub(super) wanted: &'a MatchSettings,
    /// Parts that somebody linked or pinned to each other.
    pub(super) said: Vec<[usize; 2]>,
    pins: Vec<LocatedPin>,
    parts: [DesignParts<'a>; 2],
    pub(super) groups: Vec<PartGroup>,
    /// For each group the pieces that its single part is cut into; none where
    /// it is not cut.
    pub(super) pieces: Vec<Option<Vec<Region>>>,
    is_crowd: bool,
}

/// The parts of a design, and their centres.
#[derive(Clone)]
struct DesignParts<'a> {
    regions: Vec<&'a Region>,
    centres: Vec<DVec2>,
}

impl<'a> DesignParts<'a> {
    fn of(design: &'a Regions) -> Self {
        Self {
            regions: design.iter().collect(),
            centres: design.iter().map(|r| centre(&r.outer)).collect(),
        }
    }
}

impl<'a> MatchPlan<'a> {
    /// Pairs the parts, by how they look besides, and splits those that become
    /// several.
    pub(crate) fn new(
        designs: [&'a Regions; 2],
        looks: &'a PartLooks,
        wanted: &'a MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, RegionMatchError> {
        locate::check(wanted)?;
        let pins = locate::pins(wanted, designs);
        let mut prepared = Self {
            groups: grouped(designs, looks, wanted, &pins)?,
            said: fixed_pairs(designs, wanted, &pins),
            parts: designs.map(DesignParts::of),
            is_crowd: many_rings::has_many_rings(designs),
            designs,
            looks,
            wanted,
            pins,
            pieces: Vec::new(),
        };
        let groups = prepared.groups.par_iter();
        prepared.pieces = groups
            .map(|group| prepared.split(group, progress))
            .collect();
        still_wanted(progress)?;
        Ok(prepared)
    }

    /// Takes groups with the pieces that each is cut into, in their order.
    pub(super) fn set_groups(&mut self, mut groups: Vec<(PartGroup, Option<Vec<Region>>)>) {
        groups.sort_by_key(|(group, _)| group.key());
        (self.groups, self.pieces) = groups.into_iter().unzip();
    }

    /// Whether a line runs along any part of a group, in which no cut may be seen.
    pub(crate) fn is_lined(&self, group: usize) -> bool {
        let parts = &self.groups[group].parts;
        let is_lined = |side: Side| parts[side].iter().any(|&k| self.looks.is_lined(side, k));
        Side::BOTH.into_iter().any(is_lined)
    }

    /// How the parts look.
    pub(crate) fn looks(&self) -> &'a PartLooks {
        self.looks
    }

    /// Whether there are so many rings that only one match is worth its time.
    pub(crate) fn is_crowd(&self) -> bool {
        self.is_crowd
    }

    /// The pieces of a group in which one part becomes several.
    pub(super) fn split(&self, group: &PartGroup, progress: &dyn Progress) -> Option<Vec<Region>> {
        let regions = self.regions(group);
        match [&regions[0][..], &regions[1][..]] {
            [[_], [_]] => None,
            [[one], several] | [several, [one]] if !several.is_empty() => {
                split(one, several, progress)
            }
            _ => None,
        }
    }

    /// What the outer ring of a part encloses.
    pub(super) fn area(&self, side: Side, part: usize) -> f64 {
        self.parts[side].regions[part].outer.signed_area()
    }

    fn regions(&self, group: &PartGroup) -> [Vec<&'a Region>; 2] {
        Side::BOTH.map(|side| {
            let parts = group.parts[side].iter();
            parts.map(|&part| self.parts[side].regions[part]).collect()
        })
    }

    pub(crate) fn groups(&self) -> &[PartGroup] {
        &self.groups
    }

    /// The match at these prices.
    pub(crate) fn matched(
        &self,
        options: &MatchOptions,
        progress: &dyn Progress,
    ) -> Result<RegionMatch, RegionMatchError> {
        checkpoint(progress, "matching", PREPARED)?;
        let rest = ProgressSpan::new(progress, PREPARED, 1.0);
        let shares = ProgressShares::new(&rest, self.groups.len());
        let groups = (0..self.groups.len()).into_par_iter();
        let holes = HolePolicy::By(many_rings::hole_rule(self.wanted.holes, self.is_crowd));
        let pieces =
            groups.map(|group| self.matched_group(group, options, holes, &shares.part(group)));
        // All first: of several failures it is the first in order that is told.
        let pieces: Vec<Result<Vec<PieceMatch>, RegionMatchError>> = pieces.collect();
        let pieces: Vec<_> = pieces.into_iter().collect::<Result<_, _>>()?;
        Ok(RegionMatch {
            pieces: pieces.concat(),
        })
    }

    /// The pieces that the group of this number becomes at these prices, in an
    /// order that does not depend on them.
    pub(crate) fn matched_group(
        &self,
        group: usize,
        options: &MatchOptions,
        holes: HolePolicy,
        progress: &dyn Progress,
    ) -> Result<Vec<PieceMatch>, RegionMatchError> {
        let options = many_rings::options(options, self.designs);
        let cut = self.pieces[group].as_deref();
        let pieces = self.pieces_of(&self.groups[group], cut, (&options, holes), progress)?;
        checkpoint(progress, "matching", 1.0)?;
        Ok(pieces)
    }

    /// The pieces that a group becomes.
    fn pieces_of(
        &self,
        group: &PartGroup,
        cut: Option<&[Region]>,
        (options, holes): (&MatchOptions, HolePolicy),
        progress: &dyn Progress,
    ) -> Result<Vec<PieceMatch>, RegionMatchError> {
        still_wanted(progress)?;
        let regions = self.regions(group);
        let task = |regions: [&Region; 2], parts: [usize; 2]| {
            match_part(&PartMatchTask {
                pins: self.pins_of(parts),
                cuts: self.cuts_of(parts),
                holes,
                options: options.clone(),
                regions,
                parts,
                progress,
            })
        };
        let (one, several, side) = match [&regions[0][..], &regions[1][..]] {
            [[a], [b]] => return Ok(vec![task([a, b], [group.parts[0][0], group.parts[1][0]])?]),
            [[_], []] => return Ok(vec![self.alone(Side::Source, group.parts[0][0])]),
            [[], [_]] => return Ok(vec![self.alone(Side::Target, group.parts[1][0])]),
            [[one], several] => (one, several, Side::Source),
            [several, [one]] => (one, several, Side::Target),
            _ => return Ok(Vec::new()),
        };
        // Pieces come in the order of the parts that they become.
        let others = &group.parts[side.other()];
        let piece = |k: usize, piece: &Region| {
            let regions = SourceTarget::on(side, piece, several[k]);
            let parts = SourceTarget::on(side, group.parts[side][0], others[k]);
            task(regions.to_array(), parts.to_array())
        };
        let Some(cut) = cut else {
            let mut first = piece(0, one)?;
            let part = group.parts[side][0];
            first.notes.push(MatchNote::Unsplit { side, part });
            let rest = others[1..].iter().map(|&k| self.alone(side.other(), k));
            return Ok(std::iter::once(first).chain(rest).collect());
        };
        let shares = ProgressShares::new(progress, cut.len());
        let pieces = cut.par_iter().enumerate().map(|(k, cut)| {
            let found = piece(k, cut)?;
            checkpoint(&shares.part(k), "matching", 1.0)?;
            Ok(found)
        });
        let pieces: Vec<Result<PieceMatch, RegionMatchError>> = pieces.collect();
        pieces.into_iter().collect()
    }

    fn pins_of(&self, parts: [usize; 2]) -> Vec<(usize, [DVec2; 2])> {
        let here = |pin: &&LocatedPin| pin.on.map(|at| at.part) == parts;
        let pins = self.pins.iter().filter(here);
        pins.map(|pin| (pin.index, pin.points)).collect()
    }

    fn cuts_of(&self, parts: [usize; 2]) -> Vec<(usize, RingCut)> {
        let here =
            |cut: &RingCut| nearest_ring(self.designs[cut.side], cut.hole).part == parts[cut.side];
        let cuts = self.wanted.cuts.iter().copied().enumerate();
        cuts.filter(|(_, cut)| here(cut)).collect()
    }

    /// A part that dies into a point, or is born from one: where it stands,
    /// moved along with its nearest neighbour.
    fn alone(&self, side: Side, part: usize) -> PieceMatch {
        let here = self.parts[side].centres[part];
        let mut nearest = (f64::INFINITY, DVec2::ZERO);
        for group in &self.groups {
            for &own in &group.parts[side] {
                let a = self.parts[side].centres[own];
                for &other in &group.parts[side.other()] {
                    let b = self.parts[side.other()].centres[other];
                    if a.distance_squared(here) < nearest.0 {
                        nearest = (a.distance_squared(here), b - a);
                    }
                }
            }
        }
        let region = self.parts[side].regions[part];
        let parts = SourceTarget::on(side, Some(part), None);
        PieceMatch {
            rings: point_like(region, side, here, nearest.1),
            source_part: parts.source,
            target_part: parts.target,
            ..PieceMatch::default()
        }
    }
}

/// The rings of a part with the similar tiny ones across.
fn point_like(region: &Region, side: Side, here: DVec2, moved: DVec2) -> Vec<RingMatch> {
    let ring = |ring: &Ring| {
        let whole = ring.points().to_vec();
        let size = POINT_SIZE * ring.bounds().diameter();
        let point = shrunk(&whole, here, here + moved, size, 0.0);
        RingMatch::alone(side, whole, point)
    };
    region.rings().map(ring).collect()
}
