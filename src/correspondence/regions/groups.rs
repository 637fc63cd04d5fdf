//! Which parts go together: pairs, one with several, and parts alone.

use super::super::pairing::{Pairing, pair_parts, relative_centres};
use super::super::{MatchSettings, PairError, PartRule};
use super::locate::{LocatedPin, part_at};
use super::region_match::RegionMatchError;
use crate::correspondence::looks::PartLooks;
use crate::geometry::{DVec2, Region, Regions, Side};

/// A part with less of its design's area than this is born or dies rather than that
/// another is cut up for it: a leftover of a millionth had a rectangle cut along all of a
/// side.
const SPECK: f64 = 1e-3;

/// Parts that belong together: one with one, one with several, or one alone.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PartGroup {
    /// For source and target, ascending.
    pub(super) parts: [Vec<usize>; 2],
}

impl PartGroup {
    /// What groups are sorted by: their first parts, none last.
    pub(super) fn key(&self) -> [usize; 2] {
        let first = |side: Side| self.parts[side].first().copied().unwrap_or(usize::MAX);
        Side::BOTH.map(first)
    }

    /// Which part it is, of a part alone.
    pub(super) fn alone(&self) -> Option<(Side, usize)> {
        match [&self.parts[0][..], &self.parts[1][..]] {
            [&[part], []] => Some((Side::Source, part)),
            [[], &[part]] => Some((Side::Target, part)),
            _ => None,
        }
    }
}

/// Who becomes whom, by place, form and look, and as it was said by hand of parts: pairs
/// of parts, each part in one of them at least; none is the partner of a part alone.
///
/// # Errors
/// Where what was said by hand cannot be.
pub(crate) fn paired_parts(
    designs: [&Regions; 2],
    looks: &PartLooks,
    wanted: &MatchSettings,
) -> Result<Vec<[Option<usize>; 2]>, RegionMatchError> {
    let groups = grouped(designs, looks, wanted, &[])?;
    // Of one with several each goes its own way; of several with several none is left out.
    let pairs = |PartGroup { parts }: &PartGroup| -> Vec<[Option<usize>; 2]> {
        let count = parts.iter().map(Vec::len).max().unwrap_or(0);
        let of = |side: Side, k: usize| parts[side].get(k).or(parts[side].last()).copied();
        (0..count)
            .map(|k| Side::BOTH.map(|side| of(side, k)))
            .collect()
    };
    Ok(groups.iter().flat_map(pairs).collect())
}

/// All parts of both designs in groups, in the order of the source's parts.
pub(super) fn grouped(
    designs: [&Regions; 2],
    looks: &PartLooks,
    wanted: &MatchSettings,
    pins: &[LocatedPin],
) -> Result<Vec<PartGroup>, RegionMatchError> {
    let mut groups = said(designs, wanted, pins)?;
    let fixed: Vec<[usize; 2]> = groups
        .iter()
        .map(|g| [g.parts[0][0], g.parts[1][0]])
        .collect();
    // Of a group one part is fixed to one; the others are taken.
    let lone = lone(designs, wanted, &groups);
    let taken = Side::BOTH.map(|side| -> Vec<usize> {
        let more = groups.iter().flat_map(|g| g.parts[side][1..].to_vec());
        more.chain(lone.iter().flat_map(|g| g.parts[side].clone()))
            .collect()
    });
    let pairing = pair_parts(designs, looks, &fixed, [&taken[0], &taken[1]])?;
    let pairing = unmixed(pairing, looks, &fixed);
    for pair in &pairing.pairs {
        if !fixed.contains(pair) {
            groups.push(PartGroup {
                parts: pair.map(|part| vec![part]),
            });
        }
    }
    attach(&mut groups, (designs, looks), wanted.parts, &pairing);
    groups.extend(lone);
    for part in groups.iter_mut().flat_map(|g| &mut g.parts) {
        part.sort_unstable();
    }
    // Parts that are born have no number in the source: they come last.
    groups.sort_by_key(PartGroup::key);
    Ok(groups)
}

/// Lets go of pairs of a letter and something else, where anything else is paired: of a
/// wave that becomes the second letter of a word neither is recognised.
fn unmixed(pairing: Pairing, looks: &PartLooks, fixed: &[[usize; 2]]) -> Pairing {
    let is_mixed = |pair: &[usize; 2]| {
        let [a, b] = Side::BOTH.map(|side| looks.is_text(side, pair[side]));
        a != b && !fixed.contains(pair)
    };
    let (mixed, pairs): (Vec<_>, Vec<_>) = pairing.pairs.iter().copied().partition(is_mixed);
    if pairs.is_empty() {
        return pairing;
    }
    let with = |mut alone: Vec<usize>, side: Side| {
        alone.extend(mixed.iter().map(|pair| pair[side]));
        alone.sort_unstable();
        alone
    };
    Pairing {
        dying: with(pairing.dying, Side::Source),
        born: with(pairing.born, Side::Target),
        pairs,
    }
}

/// The pairs of parts that links and pins name, each once, ascending.
pub(super) fn fixed_pairs(
    designs: [&Regions; 2],
    wanted: &MatchSettings,
    pins: &[LocatedPin],
) -> Vec<[usize; 2]> {
    let linked = wanted
        .links
        .iter()
        .map(|link| Side::BOTH.map(|side| part_at(designs[side], link[side])));
    let pinned = pins.iter().map(|pin| pin.on.map(|at| at.part));
    let mut pairs: Vec<[usize; 2]> = linked.chain(pinned).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The groups that links and pins name.
fn said(
    designs: [&Regions; 2],
    wanted: &MatchSettings,
    pins: &[LocatedPin],
) -> Result<Vec<PartGroup>, RegionMatchError> {
    let mut groups: Vec<PartGroup> = Vec::new();
    for pair in fixed_pairs(designs, wanted, pins) {
        let touching = groups.iter_mut().find(|g| {
            Side::BOTH
                .iter()
                .any(|&side| g.parts[side].contains(&pair[side]))
        });
        let Some(group) = touching else {
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
        let several = group.parts.iter().all(|parts| parts.len() > 1);
        let split = group.parts.iter().any(|parts| parts.len() > 1);
        if several || (split && wanted.parts == PartRule::Alone) {
            let twice = usize::from(group.parts[1].len() == 1 || several);
            return Err(PairError::Twice(pair[1 - twice]).into());
        }
    }
    Ok(groups)
}

/// The parts that are said to have no partner, each in a group of its own; a
/// pair that is said of a part counts more.
fn lone(designs: [&Regions; 2], wanted: &MatchSettings, said: &[PartGroup]) -> Vec<PartGroup> {
    let mut lone: Vec<PartGroup> = Vec::new();
    for part in &wanted.lone {
        let mut group = PartGroup::default();
        group.parts[part.side].push(part_at(designs[part.side], part.at));
        let is_in = |g: &PartGroup| g.parts[part.side].contains(&group.parts[part.side][0]);
        if !said.iter().chain(&lone).any(is_in) {
            lone.push(group);
        }
    }
    lone
}

/// Gives the parts that are left over to a group to be split, of those that are
/// in their coat, or a group of their own.
fn attach(
    groups: &mut Vec<PartGroup>,
    (designs, looks): ([&Regions; 2], &PartLooks),
    rule: PartRule,
    pairing: &Pairing,
) {
    let splits = match rule {
        PartRule::Auto => designs.iter().any(|design| design.len() == 1),
        PartRule::Split => true,
        PartRule::Alone => false,
    };
    let places = designs.map(relative_centres);
    let areas = designs.map(|design| design.iter().map(Region::area).collect::<Vec<f64>>());
    let wholes = areas.each_ref().map(|areas| areas.iter().sum::<f64>());
    let is_speck = |side: Side, part: usize| {
        rule == PartRule::Auto && areas[side][part] < SPECK * wholes[side]
    };
    for (side, alone) in [
        (Side::Source, &pairing.dying),
        (Side::Target, &pairing.born),
    ] {
        for &part in alone {
            let may_cut = splits && !is_speck(side, part);
            let near = may_cut.then(|| nearest_group(groups, (&places, looks), side, part));
            match near.flatten() {
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

/// The group whose single part on the other side lies nearest, of those in the
/// coat of the part that may be cut.
pub(super) fn nearest_group(
    groups: &[PartGroup],
    (places, looks): (&[Vec<DVec2>; 2], &PartLooks),
    side: Side,
    part: usize,
) -> Option<usize> {
    let here = places[side][part];
    let coat = |part: usize| looks.coat(side, part);
    let is_in_coat = |g: &PartGroup| g.parts[side].iter().all(|&own| coat(own) == coat(part));
    let is_whole = |g: &PartGroup| looks.is_lined(side.other(), g.parts[side.other()][0]);
    let single = groups
        .iter()
        .enumerate()
        .filter(|(_, g)| g.parts[side.other()].len() == 1 && is_in_coat(g) && !is_whole(g));
    let far = |g: &PartGroup| places[side.other()][g.parts[side.other()][0]].distance_squared(here);
    single
        .min_by(|a, b| far(a.1).total_cmp(&far(b.1)))
        .map(|(k, _)| k)
}
