//! Plans the match of two designs: divides their parts into groups, splits parts that are matched
//! with several, and matches the groups. The plan does not depend on the match options, so that
//! several matches with different options can share it.

use super::super::{MatchOptions, MatchSettings, RingCut};
use super::closing::{outline_centre, shrink_to};
use super::groups::{PartGroup, fixed_pairs, group_parts};
use super::locate;
use super::locate::{LocatedPin, nearest_ring};
use super::many_rings;
use super::part_match::match_part;
use super::part_matcher::{HolePolicy, PartMatchTask};
use super::region_match::{
    MatchNote, POINT_SIZE, PieceMatch, RegionMatch, RegionMatchError, RingMatch,
};
use super::split::split;
use crate::correspondence::looks::PartAppearances;
use crate::geometry::{DVec2, Region, Regions, Ring, Side, SourceTarget};
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, check_cancelled, checkpoint};
use rayon::prelude::*;

/// Progress reported once parts are paired and split, in [0, 1] (heuristic).
const PREPARED: f64 = 0.2;

/// Two designs with their parts grouped and, where needed, split.
#[derive(Clone)]
pub(crate) struct MatchPlan<'a> {
    pub(super) designs: [&'a Regions; 2],
    appearances: &'a PartAppearances,
    pub(super) settings: &'a MatchSettings,
    /// Pairs of parts that the user linked or pinned.
    pub(super) fixed_pairs: Vec<[usize; 2]>,
    /// Pins with the rings on which their points lie.
    pins: Vec<LocatedPin>,
    parts: [DesignParts<'a>; 2],
    pub(super) groups: Vec<PartGroup>,
    /// For each group: the pieces into which its single part is cut, in the order of the parts that
    /// they match; `None` if it is not cut.
    pub(super) pieces: Vec<Option<Vec<Region>>>,
    /// Whether a design has so many rings that the effort is limited (see [`many_rings`]).
    has_many_rings: bool,
}

/// Parts of a design, with the centres of their outer rings.
#[derive(Clone)]
struct DesignParts<'a> {
    regions: Vec<&'a Region>,
    centres: Vec<DVec2>,
}

impl<'a> DesignParts<'a> {
    fn of(design: &'a Regions) -> Self {
        Self {
            regions: design.iter().collect(),
            centres: design.iter().map(|r| outline_centre(&r.outer)).collect(),
        }
    }
}

impl<'a> MatchPlan<'a> {
    /// Pairs the parts by position, shape and appearance, and splits each part matched with
    /// several.
    ///
    /// # Errors
    /// [`RegionMatchError`] for settings that contradict each other, or if the work is cancelled.
    pub(crate) fn new(
        designs: [&'a Regions; 2],
        looks: &'a PartAppearances,
        settings: &'a MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, RegionMatchError> {
        locate::check_places(settings)?;
        let pins = locate::locate_pins(settings, designs);
        let mut plan = Self {
            groups: group_parts(designs, looks, settings, &pins)?,
            fixed_pairs: fixed_pairs(designs, settings, &pins),
            parts: designs.map(DesignParts::of),
            has_many_rings: many_rings::has_many_rings(designs),
            designs,
            appearances: looks,
            settings,
            pins,
            pieces: Vec::new(),
        };
        let groups = plan.groups.par_iter();
        plan.pieces = groups
            .map(|group| plan.split_part(group, progress))
            .collect();
        check_cancelled(progress)?;
        Ok(plan)
    }

    /// Replaces the groups and their pieces, sorted by [`PartGroup::key`].
    pub(super) fn set_groups(&mut self, mut groups: Vec<(PartGroup, Option<Vec<Region>>)>) {
        groups.sort_by_key(|(group, _)| group.key());
        (self.groups, self.pieces) = groups.into_iter().unzip();
    }

    /// Returns whether a paint layer with a line (stroke) contains any part of the group with this
    /// index. A cut through such a part would be visible.
    pub(crate) fn is_stroked(&self, group: usize) -> bool {
        let parts = &self.groups[group].parts;
        let is_lined = |side: Side| {
            parts[side]
                .iter()
                .any(|&k| self.appearances.is_lined(side, k))
        };
        Side::BOTH.into_iter().any(is_lined)
    }

    /// Returns the appearance of all parts: paint, layer, name, and whether they are text.
    pub(crate) fn appearances(&self) -> &'a PartAppearances {
        self.appearances
    }

    /// Returns whether a design has so many rings that only one match is tried.
    pub(crate) fn has_many_rings(&self) -> bool {
        self.has_many_rings
    }

    /// Cuts the single part of a group into one piece for each of the several parts in the other
    /// design. Returns `None` for other groups, or if no cut is found.
    pub(super) fn split_part(
        &self,
        group: &PartGroup,
        progress: &dyn Progress,
    ) -> Option<Vec<Region>> {
        let regions = self.regions(group);
        match [&regions[0][..], &regions[1][..]] {
            [[_], [_]] => None,
            [[one], several] | [several, [one]] if !several.is_empty() => {
                split(one, several, progress)
            }
            _ => None,
        }
    }

    /// Returns the area enclosed by the outer ring of a part, including its holes.
    pub(super) fn area(&self, side: Side, part: usize) -> f64 {
        self.parts[side].regions[part].outer.signed_area()
    }

    /// Returns the regions of a group's parts, source and target.
    fn regions(&self, group: &PartGroup) -> [Vec<&'a Region>; 2] {
        Side::BOTH.map(|side| {
            let parts = group.parts[side].iter();
            parts.map(|&part| self.parts[side].regions[part]).collect()
        })
    }

    /// Returns whether rings of any part of the group with this index touch each other.
    pub(crate) fn has_contacts(&self, group: usize) -> bool {
        let regions = self.regions(&self.groups[group]);
        Side::BOTH.into_iter().any(|side| {
            let diameter = self.designs[side].bounds().diameter();
            regions[side].iter().any(|part| part.has_contacts(diameter))
        })
    }

    /// Returns the groups of parts that are matched together.
    pub(crate) fn groups(&self) -> &[PartGroup] {
        &self.groups
    }

    /// Matches all groups with the given options.
    ///
    /// # Errors
    /// [`RegionMatchError`] for pins or cuts that cannot be satisfied, or if the work is cancelled.
    pub(crate) fn match_all_groups(
        &self,
        options: &MatchOptions,
        progress: &dyn Progress,
    ) -> Result<RegionMatch, RegionMatchError> {
        checkpoint(progress, "matching", PREPARED)?;
        let remaining = ProgressSpan::new(progress, PREPARED, 1.0);
        let shares = ProgressShares::new(&remaining, self.groups.len());
        let groups = (0..self.groups.len()).into_par_iter();
        let holes = HolePolicy::Paired(many_rings::hole_rule(
            self.settings.holes,
            self.has_many_rings,
        ));
        let pieces =
            groups.map(|group| self.match_group(group, options, holes, &shares.part(group)));
        // Collect all results first, so that the reported error does not depend on the order of
        // completion.
        let pieces: Vec<Result<Vec<PieceMatch>, RegionMatchError>> = pieces.collect();
        let pieces: Vec<_> = pieces.into_iter().collect::<Result<_, _>>()?;
        Ok(RegionMatch {
            pieces: pieces.concat(),
        })
    }

    /// Matches the group with the index `group`, using the given options. The order of its pieces
    /// does not depend on the options.
    ///
    /// # Errors
    /// [`RegionMatchError`] for pins or cuts that cannot be satisfied, or if the work is cancelled.
    pub(crate) fn match_group(
        &self,
        group: usize,
        options: &MatchOptions,
        holes: HolePolicy,
        progress: &dyn Progress,
    ) -> Result<Vec<PieceMatch>, RegionMatchError> {
        let options = many_rings::options(options, self.designs);
        let cut = self.pieces[group].as_deref();
        let group = &self.groups[group];
        let pieces = self.match_group_pieces(group, cut, &options, holes, progress)?;
        checkpoint(progress, "matching", 1.0)?;
        Ok(pieces)
    }

    /// Matches the parts of a group. If its single part was cut, `cut` holds the pieces, which are
    /// matched instead of the part.
    fn match_group_pieces(
        &self,
        group: &PartGroup,
        cut: Option<&[Region]>,
        options: &MatchOptions,
        holes: HolePolicy,
        progress: &dyn Progress,
    ) -> Result<Vec<PieceMatch>, RegionMatchError> {
        check_cancelled(progress)?;
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
            [[_], []] => return Ok(vec![self.unmatched_piece(Side::Source, group.parts[0][0])]),
            [[], [_]] => return Ok(vec![self.unmatched_piece(Side::Target, group.parts[1][0])]),
            [[one], several] => (one, several, Side::Source),
            [several, [one]] => (one, several, Side::Target),
            _ => return Ok(Vec::new()),
        };
        // The pieces are in the same order as the parts that they match.
        let others = &group.parts[side.other()];
        let match_piece = |k: usize, piece: &Region| {
            let regions = SourceTarget::with_side(side, piece, several[k]);
            let parts = SourceTarget::with_side(side, group.parts[side][0], others[k]);
            task(regions.to_array(), parts.to_array())
        };
        let Some(cut) = cut else {
            let mut first = match_piece(0, one)?;
            let part = group.parts[side][0];
            first.notes.push(MatchNote::Unsplit { side, part });
            let rest = others[1..]
                .iter()
                .map(|&k| self.unmatched_piece(side.other(), k));
            return Ok(std::iter::once(first).chain(rest).collect());
        };
        let shares = ProgressShares::new(progress, cut.len());
        let pieces = cut.par_iter().enumerate().map(|(k, cut)| {
            let matched = match_piece(k, cut)?;
            checkpoint(&shares.part(k), "matching", 1.0)?;
            Ok(matched)
        });
        let pieces: Vec<Result<PieceMatch, RegionMatchError>> = pieces.collect();
        pieces.into_iter().collect()
    }

    /// Returns each pin on a pair of parts: its index among all pins, and its points in source and
    /// target.
    fn pins_of(&self, parts: [usize; 2]) -> Vec<(usize, [DVec2; 2])> {
        let is_on_pair = |pin: &&LocatedPin| pin.on.map(|at| at.part) == parts;
        let pins = self.pins.iter().filter(is_on_pair);
        pins.map(|pin| (pin.index, pin.points)).collect()
    }

    /// Returns each cut through one of two parts, with its index among all cuts.
    fn cuts_of(&self, parts: [usize; 2]) -> Vec<(usize, RingCut)> {
        let is_on_pair =
            |cut: &RingCut| nearest_ring(self.designs[cut.side], cut.hole).part == parts[cut.side];
        let cuts = self.settings.cuts.iter().copied().enumerate();
        cuts.filter(|(_, cut)| is_on_pair(cut)).collect()
    }

    /// Returns the match of an unmatched part with a point of the other design. The point is the
    /// part's centre, displaced by the same vector as the centre of the nearest matched part.
    fn unmatched_piece(&self, side: Side, part: usize) -> PieceMatch {
        let here = self.parts[side].centres[part];
        let mut nearest = (f64::INFINITY, DVec2::ZERO);
        for group in &self.groups {
            for &neighbour in &group.parts[side] {
                let a = self.parts[side].centres[neighbour];
                for &partner in &group.parts[side.other()] {
                    let b = self.parts[side.other()].centres[partner];
                    if a.distance_squared(here) < nearest.0 {
                        nearest = (a.distance_squared(here), b - a);
                    }
                }
            }
        }
        let region = self.parts[side].regions[part];
        let parts = SourceTarget::with_side(side, Some(part), None);
        PieceMatch {
            rings: transient_rings(region, side, here, nearest.1),
            source_part: parts.source,
            target_part: parts.target,
            ..PieceMatch::default()
        }
    }
}

/// Matches each ring of an unmatched part with a tiny ring that is created for it in the other
/// design. The tiny rings are copies of the rings, scaled down about the centre of the part,
/// `here`, and moved by `displacement`.
fn transient_rings(
    region: &Region,
    side: Side,
    here: DVec2,
    displacement: DVec2,
) -> Vec<RingMatch> {
    let ring = |ring: &Ring| {
        let whole = ring.points().to_vec();
        let size = POINT_SIZE * ring.bounds().diameter();
        let point = shrink_to(&whole, here, here + displacement, size, 0.0);
        RingMatch::transient(side, whole, point)
    };
    region.rings().map(ring).collect()
}
