//! Divides the parts of two designs into groups: one part with one, one part with several, or a
//! single unmatched part.

use super::super::pairing::{Pairing, pair_parts, relative_centres};
use super::super::{MatchSettings, PairError, PartRule};
use super::locate::{LocatedPin, part_at};
use super::region_match::RegionMatchError;
use crate::correspondence::looks::PartAppearances;
use crate::geometry::{DVec2, Region, Regions, Side};

/// Minimum area of an unmatched part that may cause a split, as a fraction of its design's area;
/// smaller parts appear or disappear. Without this limit, a tiny part could cause a cut along a
/// whole side of a large one (heuristic).
const MIN_SPLIT_AREA: f64 = 1e-3;

/// Parts that are matched together: one with one, one with several, or a single unmatched part.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PartGroup {
    /// Indices of the group's parts in the source and in the target, each list ascending.
    pub(super) parts: [Vec<usize>; 2],
}

impl PartGroup {
    /// Returns the key by which groups are sorted: the index of the group's first part in the
    /// source, then in the target. A group without a part in a design has `usize::MAX` there, so it
    /// comes last.
    pub(super) fn key(&self) -> [usize; 2] {
        let first = |side: Side| self.parts[side].first().copied().unwrap_or(usize::MAX);
        Side::BOTH.map(first)
    }

    /// If the group is a single unmatched part, returns the part's design and its index.
    pub(super) fn unmatched_part(&self) -> Option<(Side, usize)> {
        match [&self.parts[0][..], &self.parts[1][..]] {
            [&[part], []] => Some((Side::Source, part)),
            [[], &[part]] => Some((Side::Target, part)),
            _ => None,
        }
    }
}

/// Pairs the parts of two designs by position, shape, appearance and the user's settings. Each part
/// is in at least one pair; unmatched parts have `None` as partner.
///
/// A group of one part with several gives one pair for each of the several parts.
///
/// # Errors
/// [`RegionMatchError`] for links or pins that contradict each other.
pub(crate) fn paired_parts(
    designs: [&Regions; 2],
    looks: &PartAppearances,
    settings: &MatchSettings,
) -> Result<Vec<[Option<usize>; 2]>, RegionMatchError> {
    let groups = group_parts(designs, looks, settings, &[])?;
    // If one of the lists of parts is shorter, its last part is repeated, so that no part is
    // omitted.
    let pairs = |PartGroup { parts }: &PartGroup| -> Vec<[Option<usize>; 2]> {
        let count = parts.iter().map(Vec::len).max().unwrap_or(0);
        let part_or_last =
            |side: Side, k: usize| parts[side].get(k).or(parts[side].last()).copied();
        (0..count)
            .map(|k| Side::BOTH.map(|side| part_or_last(side, k)))
            .collect()
    };
    Ok(groups.iter().flat_map(pairs).collect())
}

/// Divides all parts of both designs into groups, in the order of the source's parts.
///
/// # Errors
/// [`RegionMatchError`] for links or pins that contradict each other.
pub(super) fn group_parts(
    designs: [&Regions; 2],
    looks: &PartAppearances,
    settings: &MatchSettings,
    pins: &[LocatedPin],
) -> Result<Vec<PartGroup>, RegionMatchError> {
    let mut groups = user_groups(designs, settings, pins)?;
    let fixed: Vec<[usize; 2]> = groups
        .iter()
        .map(|g| [g.parts[0][0], g.parts[1][0]])
        .collect();
    // Pass the first pair of each group to the pairing as a fixed pair. Exclude the group's other
    // parts, and parts declared unmatched, from the pairing.
    let unmatched = declared_unmatched(designs, settings, &groups);
    let fixed_parts = Side::BOTH.map(|side| -> Vec<usize> {
        let additional = groups.iter().flat_map(|g| g.parts[side][1..].to_vec());
        additional
            .chain(unmatched.iter().flat_map(|g| g.parts[side].clone()))
            .collect()
    });
    let unlike = unlike_parts(looks, &fixed, &fixed_parts);
    let excluded = Side::BOTH.map(|side| [&fixed_parts[side][..], &unlike[side]].concat());
    let mut pairing = pair_parts(designs, looks, &fixed, [&excluded[0], &excluded[1]])?;
    pairing.leave_unmatched(unlike);
    let pairing = without_mismatches(pairing, looks, &fixed);
    for pair in &pairing.pairs {
        if !fixed.contains(pair) {
            groups.push(PartGroup {
                parts: pair.map(|part| vec![part]),
            });
        }
    }
    assign_unmatched(&mut groups, designs, looks, settings.parts, &pairing);
    groups.extend(unmatched);
    for part in groups.iter_mut().flat_map(|g| &mut g.parts) {
        part.sort_unstable();
    }
    // Parts that exist only in the target have no source index; they come last.
    groups.sort_by_key(PartGroup::key);
    Ok(groups)
}

/// Returns for each design the parts that are not paired because they do not look like the other
/// design (see [`PartAppearances::unlike_parts`]), without those that the user grouped or declared
/// unmatched. If the user grouped a part of a design, its other parts may be paired with any part.
fn unlike_parts(
    looks: &PartAppearances,
    fixed: &[[usize; 2]],
    fixed_parts: &[Vec<usize>; 2],
) -> [Vec<usize>; 2] {
    if !fixed.is_empty() {
        return [Vec::new(), Vec::new()];
    }
    let mut unlike = looks.unlike_parts();
    for side in Side::BOTH {
        unlike[side].retain(|part| !fixed_parts[side].contains(part));
    }
    unlike
}

/// Dissolves pairs of unequal parts, provided that other pairs remain: pairs of a letter with a
/// part that is not a letter (if a wave turned into a letter, neither would be recognisable), and
/// pairs of a part with a part of another name, if its own name occurs in the other design. Parts
/// with the same name always stay together.
fn without_mismatches(pairing: Pairing, looks: &PartAppearances, fixed: &[[usize; 2]]) -> Pairing {
    let common_names = looks.common_names();
    let is_mixed = |pair: &[usize; 2]| {
        let [a, b] = Side::BOTH.map(|side| looks.is_text(side, pair[side]));
        let is_common = |side: Side| {
            let name = looks.name(side, pair[side]);
            common_names.contains(name)
        };
        let is_mismatch = a != b || Side::BOTH.into_iter().any(is_common);
        is_mismatch && !fixed.contains(pair) && !looks.are_namesakes(*pair)
    };
    let (mixed, pairs): (Vec<_>, Vec<_>) = pairing.pairs.iter().copied().partition(is_mixed);
    if pairs.is_empty() {
        return pairing;
    }
    let mut remaining = Pairing { pairs, ..pairing };
    remaining.leave_unmatched(Side::BOTH.map(|side| mixed.iter().map(|pair| pair[side]).collect()));
    remaining
}

/// Returns the pairs of parts that the user's links and pins name, each once, ascending.
pub(super) fn fixed_pairs(
    designs: [&Regions; 2],
    settings: &MatchSettings,
    pins: &[LocatedPin],
) -> Vec<[usize; 2]> {
    let linked = settings
        .links
        .iter()
        .map(|link| Side::BOTH.map(|side| part_at(designs[side], link[side])));
    let pinned = pins.iter().map(|pin| pin.on.map(|at| at.part));
    let mut pairs: Vec<[usize; 2]> = linked.chain(pinned).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Returns the groups of the parts that the user's links and pins name.
///
/// # Errors
/// [`PairError::Twice`] if several parts would be grouped with several, or if several would be
/// grouped with one although the rule for parts forbids splitting.
fn user_groups(
    designs: [&Regions; 2],
    settings: &MatchSettings,
    pins: &[LocatedPin],
) -> Result<Vec<PartGroup>, RegionMatchError> {
    let mut groups: Vec<PartGroup> = Vec::new();
    for pair in fixed_pairs(designs, settings, pins) {
        let has_part = |group: &&PartGroup| {
            Side::BOTH
                .iter()
                .any(|&side| group.parts[side].contains(&pair[side]))
        };
        // Joined by the pair, two groups would have several parts in both designs.
        if groups.iter().filter(has_part).count() > 1 {
            return Err(PairError::Twice(pair[Side::Source]).into());
        }
        // Finds the group that already contains a part of this pair. That part is then in two
        // pairs.
        let touching = groups.iter_mut().find_map(|group| {
            let is_in_group = |&side: &Side| group.parts[side].contains(&pair[side]);
            let side = Side::BOTH.into_iter().find(is_in_group)?;
            Some((group, pair[side]))
        });
        let Some((group, shared)) = touching else {
            groups.push(PartGroup {
                parts: pair.map(|part| vec![part]),
            });
            continue;
        };
        for (parts, part) in group.parts.iter_mut().zip(pair) {
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
        let has_several_on_both = group.parts.iter().all(|parts| parts.len() > 1);
        let needs_split = group.parts.iter().any(|parts| parts.len() > 1);
        if has_several_on_both || (needs_split && settings.parts == PartRule::Transient) {
            return Err(PairError::Twice(shared).into());
        }
    }
    Ok(groups)
}

/// Returns the parts that the user declared unmatched, each as a separate group. Links and pins
/// take precedence.
fn declared_unmatched(
    designs: [&Regions; 2],
    settings: &MatchSettings,
    user_groups: &[PartGroup],
) -> Vec<PartGroup> {
    let mut unmatched: Vec<PartGroup> = Vec::new();
    for part in &settings.lone {
        let mut group = PartGroup::default();
        group.parts[part.side].push(part_at(designs[part.side], part.at));
        let is_in = |g: &PartGroup| g.parts[part.side].contains(&group.parts[part.side][0]);
        if !user_groups.iter().chain(&unmatched).any(is_in) {
            unmatched.push(group);
        }
    }
    unmatched
}

/// Adds each unmatched part to the nearest suitable group of its paint layer: one whose single part
/// in the other design may be split. If there is no such group, the part becomes a separate group.
fn assign_unmatched(
    groups: &mut Vec<PartGroup>,
    designs: [&Regions; 2],
    looks: &PartAppearances,
    rule: PartRule,
    pairing: &Pairing,
) {
    let may_split = match rule {
        PartRule::Auto => designs.iter().any(|design| design.len() == 1),
        PartRule::Split => true,
        PartRule::Transient => false,
    };
    let centres = designs.map(relative_centres);
    let areas = designs.map(|design| design.iter().map(Region::area).collect::<Vec<f64>>());
    let total_areas = areas.each_ref().map(|areas| areas.iter().sum::<f64>());
    let is_too_small = |side: Side, part: usize| {
        rule == PartRule::Auto && areas[side][part] < MIN_SPLIT_AREA * total_areas[side]
    };
    for (side, unmatched) in [
        (Side::Source, &pairing.source_only),
        (Side::Target, &pairing.target_only),
    ] {
        for &part in unmatched {
            let may_split_for = may_split && !is_too_small(side, part);
            let nearest = may_split_for.then(|| nearest_group(groups, &centres, looks, side, part));
            match nearest.flatten() {
                Some(group) => groups[group].parts[side].push(part),
                None => {
                    let mut group = PartGroup::default();
                    group.parts[side].push(part);
                    groups.push(group);
                }
            }
        }
    }
}

/// Returns the index of the group whose single part in the other design is nearest to the given
/// part. Considers only groups in the part's paint layer whose single part may be cut.
pub(super) fn nearest_group(
    groups: &[PartGroup],
    centres: &[Vec<DVec2>; 2],
    looks: &PartAppearances,
    side: Side,
    part: usize,
) -> Option<usize> {
    let centre = centres[side][part];
    let layer = |part: usize| looks.paint_layer(side, part);
    let is_same_layer = |g: &PartGroup| {
        g.parts[side]
            .iter()
            .all(|&member| layer(member) == layer(part))
    };
    let is_lined = |g: &PartGroup| looks.is_lined(side.other(), g.parts[side.other()][0]);
    let candidates = groups
        .iter()
        .enumerate()
        .filter(|(_, g)| g.parts[side.other()].len() == 1 && is_same_layer(g) && !is_lined(g));
    let distance =
        |g: &PartGroup| centres[side.other()][g.parts[side.other()][0]].distance_squared(centre);
    candidates
        .min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)))
        .map(|(k, _)| k)
}
