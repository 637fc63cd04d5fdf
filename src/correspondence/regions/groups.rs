//! Which parts go together: pairs, one with several, and parts alone.

use super::super::parts::{Pairing, pair_other_parts, relative_centre};
use super::super::{Matching, PairError, PartRule, RingCut, Side};
use super::closing::{centre, shrunk};
use super::locate::{Pinned, nearest_ring, part_at, rings};
use super::piece::{Task, matched};
use super::split::split;
use super::{POINT_SIZE, PieceMatch, RegionMatchError, RingKind, RingMatch};
use crate::geometry::{DVec2, Region, Regions};

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
    let taken = [0, 1].map(|side| -> Vec<usize> {
        groups
            .iter()
            .flat_map(|g| g.parts[side][1..].to_vec())
            .collect()
    });
    let [source, target] = designs;
    let pairing = pair_other_parts(source, target, &fixed, [&taken[0], &taken[1]])?;
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
    groups.sort_by_key(|group| {
        let first = |side: usize| group.parts[side].first().copied().unwrap_or(usize::MAX);
        [first(0), first(1)]
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
        .map(|link| Side::BOTH.map(|side| part_at(designs[side.index()], link.of(side))));
    let pinned = pins.iter().map(|pin| pin.on.map(|at| at.part));
    let mut pairs: Vec<[usize; 2]> = linked.chain(pinned).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut groups: Vec<Group> = Vec::new();
    for pair in pairs {
        let touching = groups
            .iter_mut()
            .find(|g| (0..2).any(|side| g.parts[side].contains(&pair[side])));
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
    for (side, alone) in [(0, &pairing.dying), (1, &pairing.born)] {
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
    side: usize,
    part: usize,
) -> Option<usize> {
    let place = |side: usize, part: usize| {
        let region = designs[side].iter().nth(part);
        region.map_or(DVec2::ZERO, |region| relative_centre(region, designs[side]))
    };
    let here = place(side, part);
    let single = groups
        .iter()
        .enumerate()
        .filter(|(_, g)| g.parts[1 - side].len() == 1);
    let far = |g: &Group| place(1 - side, g.parts[1 - side][0]).distance_squared(here);
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
    let region = |side: usize, part: usize| designs[side].iter().nth(part);
    let regions = [0, 1].map(|side| -> Vec<&Region> {
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
            regions: [regions[0], regions[1]],
            parts,
        };
        matched(&piece)
    };
    let alone = |side: usize, part: usize| alone(designs, all, side, part);
    match (&regions[0][..], &regions[1][..]) {
        ([a], [b]) => Ok(vec![task([a, b], [group.parts[0][0], group.parts[1][0]])?]),
        ([_], []) => Ok(vec![alone(0, group.parts[0][0])]),
        ([], [_]) => Ok(vec![alone(1, group.parts[1][0])]),
        ([one], several) | (several, [one]) => {
            let side = usize::from(group.parts[0].len() > 1); // the one that is split
            let numbers = |k: usize| {
                let mut parts = [group.parts[side][0]; 2];
                parts[1 - side] = group.parts[1 - side][k];
                parts
            };
            let Some(cut) = split(one, several) else {
                let first = task(ordered(side, one, several[0]), numbers(0))?;
                let rest = group.parts[1 - side][1..]
                    .iter()
                    .map(|&k| alone(1 - side, k));
                return Ok(std::iter::once(first).chain(rest).collect());
            };
            let pieces = cut.iter().zip(several).enumerate();
            pieces
                .map(|(k, (piece, other))| task(ordered(side, piece, other), numbers(k)))
                .collect()
        }
        _ => Ok(Vec::new()),
    }
}

/// Source and target, where the first is of `side`.
fn ordered<'a>(side: usize, first: &'a Region, second: &'a Region) -> [&'a Region; 2] {
    if side == 0 {
        [first, second]
    } else {
        [second, first]
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
    let here = |cut: &RingCut| {
        let side = cut.side.index();
        nearest_ring(designs[side], cut.hole).part == parts[side]
    };
    let cuts = wanted.cuts.iter().copied().enumerate();
    cuts.filter(|(_, cut)| here(cut)).collect()
}

/// A part that dies into a point, or is born from one: where it stands, moved
/// along with its nearest neighbour.
fn alone(designs: [&Regions; 2], all: &[Group], side: usize, part: usize) -> PieceMatch {
    let region = |side: usize, part: usize| designs[side].iter().nth(part);
    let here = region(side, part).map_or(DVec2::ZERO, |r| centre(&r.outer));
    let mut nearest = (f64::INFINITY, DVec2::ZERO);
    for group in all {
        for &own in &group.parts[side] {
            for &other in &group.parts[1 - side] {
                let (Some(a), Some(b)) = (region(side, own), region(1 - side, other)) else {
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
    let mut piece = PieceMatch {
        rings,
        source_part: None,
        target_part: None,
        cuts: Vec::new(),
        rotation: 0.0,
        cost: 0.0,
    };
    if side == 0 {
        piece.source_part = Some(part);
    } else {
        piece.target_part = Some(part);
    }
    piece
}

/// The rings of a part with the similar tiny ones across.
fn point_like(region: &Region, side: usize, here: DVec2, moved: DVec2) -> Vec<RingMatch> {
    let size = region.outer.bounds().diameter();
    let ring = |ring: &crate::geometry::Ring| {
        let whole = ring.points().to_vec();
        let extent = ring.bounds().diameter();
        let point = shrunk(
            &whole,
            here,
            here + moved,
            POINT_SIZE * size * (extent / size),
            0.0,
        );
        if side == 0 {
            RingMatch {
                source: whole,
                target: point,
                kind: RingKind::Closes,
            }
        } else {
            RingMatch {
                source: point,
                target: whole,
                kind: RingKind::Opens,
            }
        }
    };
    rings(region).map(ring).collect()
}
