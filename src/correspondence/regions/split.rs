//! One part cut into as many pieces as the other design has parts.
//!
//! Cuts are straight, from boundary to boundary. They are ranked by how well
//! the areas and the places of the two sides agree with what is wanted and by
//! their length; the best few are then matched, and the best match is kept.
//! More than two pieces are cut off one after another, along the line on
//! which the wanted parts lie. Many are halved and halved again, and only
//! ranked: their form says little of a part of a part.

use super::super::boundary::match_curves;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchOptions;
use super::ring_cut::coarse_options;
use crate::geometry::{DVec2, Region, Ring, segments_touch};
use crate::work::progress::Progress;
use rayon::prelude::*;

/// Places of the boundary between which cuts are tried.
/// The cuts grow with its square; a limb thinner than a fiftieth of the
/// boundary may find none at its root.
const PLACES: u32 = 56;

/// Cuts that are matched.
/// Ranking is cheap and matching is not: more would cost time, fewer trust
/// the ranking more than it deserves.
const TRIED: usize = 10;

/// What areas, places and length count in the ranking; and what the ranking
/// counts against the match.
/// Areas rule, since a piece of the wrong size must grow; no measure fixed
/// the shares.
const AREA: f64 = 1.0;
const PLACE: f64 = 0.6;
const LENGTH: f64 = 0.35;
const RANK: f64 = 0.15;

/// Up to so many pieces are cut off one after another, each cut with the
/// matches of the best few: a second for 16, 40 for 100, and a first film waits for it.
const FEW: usize = 8;

/// The pieces in the order of `wanted`, or none if no straight cut is found,
/// or on a cancel.
pub(super) fn split(
    region: &Region,
    wanted: &[&Region],
    progress: &dyn Progress,
) -> Option<Vec<Region>> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    let line = line_of(wanted);
    let along = |k: usize| middle(wanted[k]).dot(line);
    order.sort_by(|&a, &b| along(a).total_cmp(&along(b)));
    let mut pieces = vec![None; wanted.len()];
    if wanted.len() > FEW {
        halve(region.clone(), wanted, &order, &mut pieces, progress)?;
        return pieces.into_iter().collect();
    }
    let mut rest = region.clone();
    for step in 0..order.len() - 1 {
        let others: Vec<&Region> = order[step + 1..].iter().map(|&k| wanted[k]).collect();
        let first = [wanted[order[step]]];
        let goal = SplitGoal::of(&first, &others);
        let [first, left] = cut_in_two(&rest, &goal, TRIED, progress)?;
        pieces[order[step]] = Some(first);
        rest = left;
    }
    // `wanted` has two parts at least: one alone is not split.
    pieces[order[order.len() - 1]] = Some(rest);
    pieces.into_iter().collect()
}

/// Cuts a region for the parts in `order` into halves, and these again.
fn halve(
    region: Region,
    wanted: &[&Region],
    order: &[usize],
    pieces: &mut [Option<Region>],
    progress: &dyn Progress,
) -> Option<()> {
    if let &[only] = order {
        pieces[only] = Some(region);
        return Some(());
    }
    let (near, far) = order.split_at(order.len() / 2);
    let those = |order: &[usize]| order.iter().map(|&k| wanted[k]).collect::<Vec<_>>();
    let (first, others) = (those(near), those(far));
    // One cut: there is nothing to match it by.
    let [first, rest] = cut_in_two(&region, &SplitGoal::of(&first, &others), 1, progress)?;
    halve(first, wanted, near, pieces, progress)?;
    halve(rest, wanted, far, pieces, progress)
}

/// The direction along which parts lie: from one of the two farthest apart to
/// the other.
fn line_of(parts: &[&Region]) -> DVec2 {
    let mut best = DVec2::X;
    let mut far = 0.0;
    for (k, a) in parts.iter().enumerate() {
        for b in &parts[k + 1..] {
            let apart = middle(b) - middle(a);
            if apart.length_squared() > far {
                far = apart.length_squared();
                best = if apart.x < 0.0 { -apart } else { apart };
            }
        }
    }
    best
}

fn middle(region: &Region) -> DVec2 {
    region.outer.bounds().centre()
}

/// What a cut is to bring about.
struct SplitGoal<'a> {
    first: &'a [&'a Region],
    others: &'a [&'a Region],
    share: f64,
    /// From the first's middle to the others', in units of the root of the area.
    apart: DVec2,
}

impl<'a> SplitGoal<'a> {
    fn of(first: &'a [&'a Region], others: &'a [&'a Region]) -> Self {
        let area = |parts: &[&Region]| parts.iter().map(|r| r.area()).sum::<f64>();
        let [first_area, other_area] = [area(first), area(others)];
        let middle_of = |parts: &[&Region], area: f64| -> DVec2 {
            parts.iter().map(|r| middle(r) * (r.area() / area)).sum()
        };
        let total = first_area + other_area;
        let apart = middle_of(others, other_area) - middle_of(first, first_area);
        Self {
            first,
            others,
            share: first_area / total,
            apart: apart / total.sqrt(),
        }
    }
}

/// The best cut of the `tried` first in rank; of one it is the first.
fn cut_in_two(
    region: &Region,
    goal: &SplitGoal,
    tried: usize,
    progress: &dyn Progress,
) -> Option<[Region; 2]> {
    let mut ranked: Vec<(f64, [Region; 2])> = Vec::new();
    for pieces in cuts(region, progress) {
        let [a, b] = &pieces.1;
        let (straight, swapped) = (rank(goal, a, b), rank(goal, b, a));
        let price = LENGTH * pieces.0 / region.area().sqrt();
        // Which of the pieces is the first is free: the better way round counts.
        if straight <= swapped {
            ranked.push((straight + price, pieces.1));
        } else {
            let [a, b] = pieces.1;
            ranked.push((swapped + price, [b, a]));
        }
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked.truncate(tried);
    let costed = ranked.into_par_iter().map(|(rank, pieces)| {
        let cost = match tried {
            1 => rank,
            _ => match_cost(goal, &pieces, progress) + RANK * rank,
        };
        (cost, pieces)
    });
    // In their order, so that of equals the first in rank is the best.
    let costed: Vec<(f64, [Region; 2])> = costed.collect();
    costed
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, pieces)| pieces)
}

fn rank(goal: &SplitGoal, first: &Region, rest: &Region) -> f64 {
    let total = first.area() + rest.area();
    let share = first.area() / total;
    let off = (share / goal.share).ln().abs() + ((1.0 - share) / (1.0 - goal.share)).ln().abs();
    let apart = (middle(rest) - middle(first)) / total.sqrt();
    AREA * off + PLACE * apart.distance(goal.apart)
}

/// How unlike the pieces are to what is wanted; only those that stand alone
/// are matched.
fn match_cost(goal: &SplitGoal, [first, rest]: &[Region; 2], progress: &dyn Progress) -> f64 {
    let cost = |piece: &Region, wanted: &Region| {
        if progress.is_cancelled() {
            return f64::INFINITY;
        }
        let curves = [
            BoundaryCurve::closed(&piece.outer),
            BoundaryCurve::closed(&wanted.outer),
        ];
        let [Ok(a), Ok(b)] = curves else {
            return f64::INFINITY;
        };
        let options = coarse_options(&MatchOptions::default());
        match_curves(&a, &b, &[], &options).map_or(f64::INFINITY, |m| m.cost())
    };
    let alone = |share: f64, piece: &Region, wanted: &[&Region]| match wanted {
        [wanted] => share * cost(piece, wanted),
        _ => 0.0,
    };
    alone(goal.share, first, goal.first) + alone(1.0 - goal.share, rest, goal.others)
}

/// All straight cuts tried, with their lengths and the two pieces; fewer on a
/// cancel.
fn cuts(region: &Region, progress: &dyn Progress) -> Vec<(f64, [Region; 2])> {
    let Ok(curve) = BoundaryCurve::closed(&region.outer) else {
        return Vec::new();
    };
    let place = |k: u32| f64::from(k) / f64::from(PLACES);
    let ends: Vec<(f64, DVec2)> = (0..PLACES)
        .map(|k| (place(k), curve.point_at(place(k))))
        .collect();
    let from = |(k, &a): (usize, &(f64, DVec2))| -> Vec<(f64, [Region; 2])> {
        let others = match progress.is_cancelled() {
            true => &[],
            false => &ends[k + 1..],
        };
        let cut = |&b: &(f64, DVec2)| {
            let pieces = cut_between(region, &curve, a, b)?;
            Some((a.1.distance(b.1), pieces))
        };
        others.iter().filter_map(cut).collect()
    };
    ends.par_iter().enumerate().flat_map_iter(from).collect()
}

fn cut_between(
    region: &Region,
    curve: &BoundaryCurve,
    (from, a): (f64, DVec2),
    (to, b): (f64, DVec2),
) -> Option<[Region; 2]> {
    if !is_free(region, a, b) {
        return None;
    }
    let between = |from: f64, to: f64| {
        let inner = curve.places().iter().zip(curve.points());
        inner.filter(move |(place, _)| from < **place && **place < to)
    };
    let mut near = vec![a];
    near.extend(between(from, to).map(|(_, p)| *p));
    near.push(b);
    let mut far = vec![b];
    far.extend(between(to, 2.0).map(|(_, p)| *p));
    far.extend(between(-1.0, from).map(|(_, p)| *p));
    far.push(a);
    let [Ok(near), Ok(far)] = [near, far].map(Ring::new) else {
        return None;
    };
    let holes_in = |ring: &Ring| -> Vec<Ring> {
        let inside = |hole: &&Ring| ring.winding(hole.points()[0]) != 0;
        region.holes.iter().filter(inside).cloned().collect()
    };
    let piece = |outer: Ring| Region {
        holes: holes_in(&outer),
        outer,
    };
    let pieces = [piece(near), piece(far)];
    pieces
        .iter()
        .all(|piece| piece.area() > 0.0)
        .then_some(pieces)
}

/// Whether the open segment runs inside the region.
fn is_free(region: &Region, a: DVec2, b: DVec2) -> bool {
    const END_SHARE: f64 = 1e-6;
    // Its own ends lie on the boundary.
    let short = [a.lerp(b, END_SHARE), b.lerp(a, END_SHARE)];
    let mut edges = region.rings().flat_map(Ring::edges);
    region.contains(a.midpoint(b)) && !edges.any(|(p, q)| segments_touch(short, [p, q]))
}
