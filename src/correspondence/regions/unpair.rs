//! Pieces that are let go: what was matched there dies, and what it was to
//! become is born.

use super::super::PartRule;
use super::groups::PartGroup;
use super::plan::MatchPlan;
use super::region_match::RegionMatch;
use crate::geometry::Side;
use crate::work::progress::Progress;

impl MatchPlan<'_> {
    /// Lets the pieces of these numbers go, of a match that was made of this.
    /// A part that was split is split anew for what is left to it, and keeps
    /// the largest where nothing would be. Whether anything was let go: what
    /// somebody linked or pinned stays together, and so does all where somebody
    /// wanted parts to be split.
    pub(crate) fn let_go(
        &mut self,
        matched: &RegionMatch,
        gone: &[usize],
        progress: &dyn Progress,
    ) -> bool {
        if gone.is_empty() || self.wanted.parts == PartRule::Split {
            return false;
        }
        let gone = |group: &PartGroup| of_pieces(matched, gone, group);
        let pieces = std::mem::take(&mut self.pieces);
        let mut groups = Vec::new();
        let mut is_other = false;
        for (group, cut) in std::mem::take(&mut self.groups).into_iter().zip(pieces) {
            let gone = gone(&group);
            if gone == PartGroup::default() || self.is_said(&group) {
                groups.push((group, cut));
                continue;
            }
            let (kept, alone) = self.parted(&group, &gone);
            is_other |= kept != group;
            if kept != PartGroup::default() {
                let pieces = self.split(&kept, progress);
                groups.push((kept, pieces));
            }
            groups.extend(each(&alone).map(|group| (group, None)));
        }
        self.set_groups(groups);
        is_other
    }

    fn is_said(&self, group: &PartGroup) -> bool {
        let is_in = |pair: &[usize; 2]| {
            Side::BOTH
                .into_iter()
                .any(|side| group.parts[side].contains(&pair[side]))
        };
        self.said.iter().any(is_in)
    }

    /// What stays together of a group, and what is alone then.
    fn parted(&self, group: &PartGroup, gone: &PartGroup) -> (PartGroup, PartGroup) {
        if group.parts.iter().all(|parts| parts.len() == 1) {
            return (PartGroup::default(), group.clone());
        }
        let (mut kept, mut alone) = (group.clone(), PartGroup::default());
        for side in Side::BOTH {
            if group.parts[side].len() == 1 {
                continue;
            }
            let is_gone = |part: &usize| gone.parts[side].contains(part);
            (alone.parts[side], kept.parts[side]) =
                group.parts[side].iter().partition(|p| is_gone(p));
            if kept.parts[side].is_empty() {
                let area = |part: usize| self.area(side, part);
                let largest = alone.parts[side]
                    .iter()
                    .copied()
                    .reduce(|a, b| if area(b) > area(a) { b } else { a });
                alone.parts[side].retain(|&part| Some(part) != largest);
                kept.parts[side].extend(largest);
            }
        }
        (kept, alone)
    }
}

/// The parts of some pieces, of those in a group.
fn of_pieces(matched: &RegionMatch, pieces: &[usize], group: &PartGroup) -> PartGroup {
    let parts = |k: usize| [matched.pieces[k].source_part, matched.pieces[k].target_part];
    let is_here = |k: &usize| {
        let parts = parts(*k);
        Side::BOTH
            .into_iter()
            .all(|side| parts[side].is_some_and(|p| group.parts[side].contains(&p)))
    };
    PartGroup {
        parts: Side::BOTH.map(|side| {
            let here = pieces.iter().copied().filter(is_here);
            let mut parts: Vec<usize> = here.filter_map(|k| parts(k)[side]).collect();
            parts.sort_unstable();
            parts.dedup();
            parts
        }),
    }
}

/// Every part of a group for itself.
fn each(group: &PartGroup) -> impl Iterator<Item = PartGroup> {
    let sides = Side::BOTH.into_iter();
    sides.flat_map(|side| {
        group.parts[side].iter().map(move |&part| {
            let mut alone = PartGroup::default();
            alone.parts[side].push(part);
            alone
        })
    })
}
