//! Unpairs pieces of a match: their parts of the source disappear, and their parts of the target
//! appear.

use super::super::PartRule;
use super::groups::PartGroup;
use super::plan::MatchPlan;
use super::region_match::RegionMatch;
use crate::geometry::Side;
use crate::work::progress::Progress;

impl MatchPlan<'_> {
    /// Unpairs the pieces of `matched` with the indices `unpaired`, and returns whether anything
    /// changed. The match must have been made from this plan.
    ///
    /// A part that was split is split again for its remaining partners. If no partner would remain,
    /// it keeps the largest one. Groups with a part that the user linked or pinned do not change.
    /// If the rule for parts is [`PartRule::Split`], no group changes.
    pub(crate) fn unpair(
        &mut self,
        matched: &RegionMatch,
        unpaired: &[usize],
        progress: &dyn Progress,
    ) -> bool {
        if unpaired.is_empty() || self.settings.parts == PartRule::Split {
            return false;
        }
        let unpaired = |group: &PartGroup| parts_of_pieces(matched, unpaired, group);
        let pieces = std::mem::take(&mut self.pieces);
        let mut groups = Vec::new();
        let mut has_changed = false;
        for (group, cut) in std::mem::take(&mut self.groups).into_iter().zip(pieces) {
            let unpaired = unpaired(&group);
            if unpaired == PartGroup::default() || self.is_user_fixed(&group) {
                groups.push((group, cut));
                continue;
            }
            let (remaining, released) = self.split_group(&group, &unpaired);
            has_changed |= remaining != group;
            if remaining != PartGroup::default() {
                let pieces = self.split_part(&remaining, progress);
                groups.push((remaining, pieces));
            }
            groups.extend(single_groups(&released).map(|group| (group, None)));
        }
        self.set_groups(groups);
        has_changed
    }

    /// Returns whether the user linked or pinned any part of the group.
    fn is_user_fixed(&self, group: &PartGroup) -> bool {
        let is_in = |pair: &[usize; 2]| {
            Side::BOTH
                .into_iter()
                .any(|side| group.parts[side].contains(&pair[side]))
        };
        self.fixed_pairs.iter().any(is_in)
    }

    /// Returns the parts of a group that stay together, and those that become unmatched. `unpaired`
    /// holds the parts of the pieces to unpair.
    fn split_group(&self, group: &PartGroup, unpaired: &PartGroup) -> (PartGroup, PartGroup) {
        if group.parts.iter().all(|parts| parts.len() == 1) {
            return (PartGroup::default(), group.clone());
        }
        let (mut remaining, mut released) = (group.clone(), PartGroup::default());
        for side in Side::BOTH {
            if group.parts[side].len() == 1 {
                continue;
            }
            let is_unpaired = |part: &usize| unpaired.parts[side].contains(part);
            (released.parts[side], remaining.parts[side]) =
                group.parts[side].iter().partition(|p| is_unpaired(p));
            if remaining.parts[side].is_empty() {
                let area = |part: usize| self.area(side, part);
                let largest = released.parts[side]
                    .iter()
                    .copied()
                    .reduce(|a, b| if area(b) > area(a) { b } else { a });
                released.parts[side].retain(|&part| Some(part) != largest);
                remaining.parts[side].extend(largest);
            }
        }
        (remaining, released)
    }
}

/// Returns the parts of the given pieces that belong to `group`; `pieces` holds indices in
/// `matched`.
fn parts_of_pieces(matched: &RegionMatch, pieces: &[usize], group: &PartGroup) -> PartGroup {
    let parts = |k: usize| [matched.pieces[k].source_part, matched.pieces[k].target_part];
    let is_here = |k: &usize| {
        let parts = parts(*k);
        Side::BOTH
            .into_iter()
            .all(|side| parts[side].is_some_and(|p| group.parts[side].contains(&p)))
    };
    PartGroup {
        parts: Side::BOTH.map(|side| {
            let in_group = pieces.iter().copied().filter(is_here);
            let mut parts: Vec<usize> = in_group.filter_map(|k| parts(k)[side]).collect();
            parts.sort_unstable();
            parts.dedup();
            parts
        }),
    }
}

/// Returns a separate group for each part of `group`.
fn single_groups(group: &PartGroup) -> impl Iterator<Item = PartGroup> {
    let sides = Side::BOTH.into_iter();
    sides.flat_map(|side| {
        group.parts[side].iter().map(move |&part| {
            let mut single = PartGroup::default();
            single.parts[side].push(part);
            single
        })
    })
}
