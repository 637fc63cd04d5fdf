//! Which parts go together: pairs, one with several, and parts alone.

use super::super::pairing::{Pairing, pair_parts, relative_centre};
use super::super::{Matching, PairError, PartRule, RingCut};
use super::closing::{centre, shrunk};
use super::locate::{Pinned, nearest_ring, part_at};
use super::outcome::{MatchNote, POINT_SIZE, PieceMatch, RegionMatchError, RingMatch};
use super::piece::matched;
use super::sides::Task;
use super::split::split;
use crate::geometry::{DVec2, Pair, Region, Regions, Side};

/// Parts that belong together: one with one, one with several, or one alone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Group {
    /// For source and target, ascending.
    pub(super) parts: [Vec<usize>; 2],
}

/// All parts of both designs in groups, in the order of the source's parts.
pub(super) fn grouped(
    designs: [&Regions; 2],
    wanted: &Matching,
    pins: &[Pinned],
) -> Result<Vec<Group>, RegionMatchError> {
    let mut groups = said(designs, wanted, pins)?;
    let fixed: Vec<[usize; 2]> = groups
        .iter()
        .map(|g| [g.parts[0][0], g.parts[1][0]])
        .collect();
    let taken = Side::BOTH.map(|side| -> Vec<usize> {
        groups
            .iter()
            .flat_map(|g| g.parts[side][1..].to_vec())
            .collect()
    });
    // Of a group one part is fixed to one; the others are taken.
    let [source, target] = designs;
    let pairing = pair_parts(source, target, &fixed, [&taken[0], &taken[1]])?;
    for pair in &pairing.pairs {
        if !fixed.contains(pair) {
            groups.push(Group {
                parts: pair.map(|part| vec![part]),
            });
        }
    }
    attach(&mut groups, designs, wanted.parts, &pairing);
    for part in groups.iter_mut().flat_map(|g| &mut g.parts) {
        part.sort_unstable();
    }
    // Parts that are born have no number in the source: they come last.
    groups.sort_by_key(|group| {
        let first = |side: Side| group.parts[side].first().copied().unwrap_or(usize::MAX);
        Side::BOTH.map(first)
    });
    Ok(groups)
}

/// The groups that links and pins name.
fn said(
    designs: [&Regions; 2],
    wanted: &Matching,
    pins: &[Pinned],
) -> Result<Vec<Group>, RegionMatchError> {
    let linked = wanted
        .links
        .iter()
        .map(|link| Side::BOTH.map(|side| part_at(designs[side], link[side])));
    let pinned = pins.iter().map(|pin| pin.on.map(|at| at.part));
    let mut pairs: Vec<[usize; 2]> = linked.chain(pinned).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut groups: Vec<Group> = Vec::new();
    for pair in pairs {
        let touching = groups.iter_mut().find(|g| {
            Side::BOTH
                .iter()
                .any(|&side| g.parts[side].contains(&pair[side]))
        });
        let Some(group) = touching else {
            groups.push(Group {
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

/// Gives the parts that are left over to a group to be split, or a group of
/// their own.
fn attach(groups: &mut Vec<Group>, designs: [&Regions; 2], rule: PartRule, pairing: &Pairing) {
    let splits = match rule {
        PartRule::Auto => designs.iter().any(|design| design.len() == 1),
        PartRule::Split => true,
        PartRule::Alone => false,
    };
    for (side, alone) in [
        (Side::Source, &pairing.dying),
        (Side::Target, &pairing.born),
    ] {
        for &part in alone {
            let near = splits.then(|| nearest_group(groups, designs, side, part));
            match near.flatten() {
                Some(group) => groups[group].parts[side].push(part),
                None => {
                    let mut group = Group::default();
                    group.parts[side].push(part);
                    groups.push(group);
                }
            }
        }
    }
}

/// The group whose single part on the other side lies nearest.
fn nearest_group(
    groups: &[Group],
    designs: [&Regions; 2],
    side: Side,
    part: usize,
) -> Option<usize> {
    let place = |side: Side, part: usize| {
        let region = designs[side].iter().nth(part);
        region.map_or(DVec2::ZERO, |region| relative_centre(region, designs[side]))
    };
    let here = place(side, part);
    let single = groups
        .iter()
        .enumerate()
        .filter(|(_, g)| g.parts[side.other()].len() == 1);
    let far = |g: &Group| place(side.other(), g.parts[side.other()][0]).distance_squared(here);
    single
        .min_by(|a, b| far(a.1).total_cmp(&far(b.1)))
        .map(|(k, _)| k)
}

/// The pieces that a group becomes.
pub(super) fn pieces(
    designs: [&Regions; 2],
    group: &Group,
    all: &[Group],
    wanted: &Matching,
    pins: &[Pinned],
) -> Result<Vec<PieceMatch>, RegionMatchError> {
    let region = |side: Side, part: usize| designs[side].iter().nth(part);
    let regions = Side::BOTH.map(|side| -> Vec<&Region> {
        group.parts[side]
            .iter()
            .filter_map(|&part| region(side, part))
            .collect()
    });
    let task = |regions: [&Region; 2], parts: [usize; 2]| {
        let piece = Task {
            pins: pins_of(pins, parts),
            cuts: cuts_of(wanted, designs, parts),
            holes: wanted.holes,
            options: wanted.options(),
            regions,
            parts,
        };
        matched(&piece)
    };
    let alone = |side: Side, part: usize| alone(designs, all, side, part);
    match (&regions[0][..], &regions[1][..]) {
        ([a], [b]) => Ok(vec![task([a, b], [group.parts[0][0], group.parts[1][0]])?]),
        ([_], []) => Ok(vec![alone(Side::Source, group.parts[0][0])]),
        ([], [_]) => Ok(vec![alone(Side::Target, group.parts[1][0])]),
        ([one], several) | (several, [one]) => {
            // The side whose single part is split.
            let side = if group.parts[0].len() > 1 {
                Side::Target
            } else {
                Side::Source
            };
            // Pieces come in the order of the parts that they become.
            let others = &group.parts[side.other()];
            let piece = |k: usize, piece| {
                let regions = Pair::on(side, piece, several[k]);
                let parts = Pair::on(side, group.parts[side][0], others[k]);
                task(regions.to_array(), parts.to_array())
            };
            let Some(cut) = split(one, several) else {
                let mut first = piece(0, one)?;
                let part = group.parts[side][0];
                first.notes.push(MatchNote::Unsplit { side, part });
                let rest = others[1..].iter().map(|&k| alone(side.other(), k));
                return Ok(std::iter::once(first).chain(rest).collect());
            };
            let pieces = cut.iter().enumerate();
            pieces.map(|(k, cut)| piece(k, cut)).collect()
        }
        _ => Ok(Vec::new()),
    }
}

fn pins_of(pins: &[Pinned], parts: [usize; 2]) -> Vec<(usize, [DVec2; 2])> {
    let here = |pin: &&Pinned| pin.on.map(|at| at.part) == parts;
    pins.iter()
        .filter(here)
        .map(|pin| (pin.index, pin.points))
        .collect()
}

fn cuts_of(wanted: &Matching, designs: [&Regions; 2], parts: [usize; 2]) -> Vec<(usize, RingCut)> {
    let here = |cut: &RingCut| nearest_ring(designs[cut.side], cut.hole).part == parts[cut.side];
    let cuts = wanted.cuts.iter().copied().enumerate();
    cuts.filter(|(_, cut)| here(cut)).collect()
}

/// A part that dies into a point, or is born from one: where it stands, moved
/// along with its nearest neighbour.
fn alone(designs: [&Regions; 2], all: &[Group], side: Side, part: usize) -> PieceMatch {
    let region = |side: Side, part: usize| designs[side].iter().nth(part);
    let here = region(side, part).map_or(DVec2::ZERO, |r| centre(&r.outer));
    let mut nearest = (f64::INFINITY, DVec2::ZERO);
    for group in all {
        for &own in &group.parts[side] {
            for &other in &group.parts[side.other()] {
                let (Some(a), Some(b)) = (region(side, own), region(side.other(), other)) else {
                    continue;
                };
                let (a, b) = (centre(&a.outer), centre(&b.outer));
                if a.distance_squared(here) < nearest.0 {
                    nearest = (a.distance_squared(here), b - a);
                }
            }
        }
    }
    let rings = region(side, part).map_or(Vec::new(), |r| point_like(r, side, here, nearest.1));
    let parts = Pair::on(side, Some(part), None);
    PieceMatch {
        rings,
        source_part: parts.source,
        target_part: parts.target,
        ..PieceMatch::default()
    }
}

/// The rings of a part with the similar tiny ones across.
fn point_like(region: &Region, side: Side, here: DVec2, moved: DVec2) -> Vec<RingMatch> {
    let size = region.outer.bounds().diameter();
    let ring = |ring: &crate::geometry::Ring| {
        let whole = ring.points().to_vec();
        let extent = ring.bounds().diameter();
        let size = POINT_SIZE * size * (extent / size);
        let point = shrunk(&whole, here, here + moved, size, 0.0);
        RingMatch::alone(side, whole, point)
    };
    region.rings().map(ring).collect()
}
