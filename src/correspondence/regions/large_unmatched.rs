//! Assigns each large unmatched part to the nearest pair of parts, so that it gets a partner.
//!
//! The pair becomes a group of several parts of one design and a single part of the other. The
//! single part is then cut into one piece for each of the several parts.

use super::super::PartRule;
use super::super::pairing::relative_centres;
use super::groups::{PartGroup, nearest_group};
use super::locate::part_at;
use super::plan::MatchPlan;
use crate::geometry::{DVec2, Region, Side};
use crate::work::progress::Progress;

/// Minimum area of an unmatched part that is assigned to a group, as a fraction of its design's
/// area (heuristic).
const MIN_AREA: f64 = 0.1;

impl MatchPlan<'_> {
    /// Returns this plan with its large unmatched parts assigned to groups. Returns `None` if there
    /// are no such parts, if no part can be cut for them, if the user chose a rule for parts, or if
    /// a design has very many rings.
    pub(crate) fn with_large_parts_assigned(&self, progress: &dyn Progress) -> Option<Self> {
        if self.settings.parts != PartRule::Auto || self.has_many_rings() {
            return None;
        }
        let centres = self.designs.map(relative_centres);
        let mut changed = self.clone();
        let mut has_changed = false;
        for (side, part) in self.large_unmatched() {
            has_changed |= changed.assign_to_nearest(side, part, &centres, progress);
        }
        has_changed.then_some(changed)
    }

    /// Returns the large unmatched parts, largest first, without those that the user declared
    /// unmatched.
    fn large_unmatched(&self) -> Vec<(Side, usize)> {
        let declared: Vec<(Side, usize)> = self
            .settings
            .lone
            .iter()
            .map(|lone| (lone.side, part_at(self.designs[lone.side], lone.at)))
            .collect();
        let total_areas = self
            .designs
            .map(|d| d.iter().map(Region::area).sum::<f64>());
        let area_fraction = |&(side, part): &(Side, usize)| {
            let part = self.designs[side].iter().nth(part);
            part.map_or(0.0, |part| part.area() / total_areas[side])
        };
        let unmatched = self.groups().iter().filter_map(PartGroup::unmatched_part);
        let mut large: Vec<(Side, usize)> = unmatched
            .filter(|part| area_fraction(part) >= MIN_AREA && !declared.contains(part))
            .collect();
        large.sort_by(|a, b| area_fraction(b).total_cmp(&area_fraction(a)));
        large
    }

    /// Assigns an unmatched part to the nearest group whose single part in the other design may be
    /// cut (see [`nearest_group`]). Returns false, and changes nothing, if there is no such group
    /// or if no suitable cut is found.
    fn assign_to_nearest(
        &mut self,
        side: Side,
        part: usize,
        centres: &[Vec<DVec2>; 2],
        progress: &dyn Progress,
    ) -> bool {
        let is_paired = |group: &&PartGroup| group.parts.iter().all(|parts| !parts.is_empty());
        let paired: Vec<PartGroup> = self.groups.iter().filter(is_paired).cloned().collect();
        let nearest = nearest_group(&paired, centres, self.appearances(), side, part);
        let Some(nearest) = nearest.map(|k| &paired[k]) else {
            return false;
        };
        let mut extended = nearest.clone();
        extended.parts[side].push(part);
        extended.parts[side].sort_unstable();
        let Some(cut) = self.split_part(&extended, progress) else {
            return false;
        };
        let groups = std::mem::take(&mut self.groups);
        let pieces = std::mem::take(&mut self.pieces);
        let is_unchanged =
            |group: &PartGroup| group != nearest && group.unmatched_part() != Some((side, part));
        let unchanged = groups.into_iter().zip(pieces);
        let mut groups: Vec<_> = unchanged.filter(|(group, _)| is_unchanged(group)).collect();
        groups.push((extended, Some(cut)));
        self.set_groups(groups);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::{MatchSettings, PartAppearances, UnmatchedPart};
    use crate::geometry::{FillRule, Regions};
    use crate::work::progress::Silent;

    fn blocks(all: &[(f64, f64, f64, f64)]) -> Regions {
        let block = |&(x, y, w, h): &(f64, f64, f64, f64)| {
            [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
                .map(DVec2::from)
                .to_vec()
        };
        let rings: Vec<Vec<DVec2>> = all.iter().map(block).collect();
        Regions::from_rings(&rings, FillRule::EvenOdd).expect("area")
    }

    /// Returns two designs: a bar and a dot, and the same with the bar in two parts.
    fn designs() -> [Regions; 2] {
        let dot = (4.5, 4.0, 1.0, 1.0);
        [
            blocks(&[(0.0, 0.0, 10.0, 3.0), dot]),
            blocks(&[(0.0, 0.0, 6.0, 3.0), dot, (7.0, 0.0, 3.0, 3.0)]),
        ]
    }

    /// Returns the number of parts in the largest group, and the number of unmatched parts.
    fn part_counts(plan: &MatchPlan) -> (usize, usize) {
        let groups = plan.groups().iter();
        let count = |group: &PartGroup| group.parts.iter().map(Vec::len).sum::<usize>();
        let largest = groups.clone().map(count).max().expect("a group");
        (
            largest,
            groups.filter_map(PartGroup::unmatched_part).count(),
        )
    }

    #[test]
    fn a_large_unmatched_part_is_cut_from_its_neighbours_partner() {
        let [one, two] = designs();
        for designs in [[&one, &two], [&two, &one]] {
            let (looks, settings) = (PartAppearances::default(), MatchSettings::default());
            let plan = MatchPlan::new(designs, &looks, &settings, &Silent).expect("designs");
            assert_eq!(part_counts(&plan), (2, 1));
            let changed = plan
                .with_large_parts_assigned(&Silent)
                .expect("a part is unmatched");
            assert_eq!(part_counts(&changed), (3, 0));
            assert!(changed.with_large_parts_assigned(&Silent).is_none());
        }
    }

    #[test]
    fn declared_and_small_unmatched_parts_stay_unmatched() {
        let [one, two] = designs();
        let looks = PartAppearances::default();
        let declared = MatchSettings {
            lone: vec![UnmatchedPart {
                side: Side::Target,
                at: DVec2::new(8.0, 1.0),
            }],
            ..MatchSettings::default()
        };
        let plan = MatchPlan::new([&one, &two], &looks, &declared, &Silent).expect("designs");
        assert!(plan.with_large_parts_assigned(&Silent).is_none());
        let small = blocks(&[
            (0.0, 0.0, 8.0, 3.0),
            (4.5, 4.0, 1.0, 1.0),
            (9.0, 0.0, 1.0, 1.0),
        ]);
        let settings = MatchSettings::default();
        let plan = MatchPlan::new([&one, &small], &looks, &settings, &Silent).expect("designs");
        assert!(plan.with_large_parts_assigned(&Silent).is_none());
    }
}
