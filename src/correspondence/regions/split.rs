//! Splits one part into several pieces, one for each part of the other design that it is matched
//! with.
//!
//! Cuts are straight, between two places of the outer boundary. They are ranked by two criteria:
//! how well the areas and positions of the two pieces agree with those of the parts to match, and
//! how short the cut is. The best few cuts are then rated by matching the pieces, and the best
//! match wins. Several pieces are cut off one after another, along the line on which the parts to
//! match lie. If pieces are many, the part is bisected repeatedly by the ranking alone, because the
//! outline of a group of parts says little about its members.

use super::super::boundary::match_curves;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchOptions;
use super::ring_cut::coarse_options;
use crate::geometry::{DVec2, Region, Ring, segments_touch};
use crate::work::progress::Progress;
use rayon::prelude::*;

/// Number of places on the boundary between which cuts are tried (resource limit: the number of
/// cuts grows with the square of this number).
const CUT_PLACES: u32 = 56;

/// Number of best-ranked cuts whose pieces are matched (resource limit).
const MATCHED_CUTS: usize = 10;

/// Weight of the error in the pieces' areas in the ranking of cuts; the other weights are relative
/// to it.
const AREA_WEIGHT: f64 = 1.0;
/// Weight of the error in the pieces' positions in the ranking of cuts (heuristic).
const POSITION_WEIGHT: f64 = 0.6;
/// Weight of a cut's length in the ranking of cuts (heuristic).
const LENGTH_WEIGHT: f64 = 0.35;
/// Weight of the ranking in the final rating of a cut: the rating is the cost of matching the
/// pieces plus this weight times the value by which the cut was ranked (heuristic).
const RANK_WEIGHT: f64 = 0.15;

/// Maximum number of pieces that are cut off one after another, each by the best of several matched
/// cuts. For more pieces, the part is bisected (resource limit: 100 pieces would take 40 s).
const MAX_SEQUENTIAL_PIECES: usize = 8;

/// Splits a region into one piece for each of `parts`, in the same order. Returns `None` if no
/// straight cut is found, or if the work is cancelled.
pub(super) fn split(
    region: &Region,
    parts: &[&Region],
    progress: &dyn Progress,
) -> Option<Vec<Region>> {
    let mut order: Vec<usize> = (0..parts.len()).collect();
    let line = main_direction(parts);
    let position = |k: usize| centre(parts[k]).dot(line);
    order.sort_by(|&a, &b| position(a).total_cmp(&position(b)));
    let mut pieces = vec![None; parts.len()];
    if parts.len() > MAX_SEQUENTIAL_PIECES {
        bisect(region.clone(), parts, &order, &mut pieces, progress)?;
        return pieces.into_iter().collect();
    }
    let mut rest = region.clone();
    for step in 0..order.len() - 1 {
        let others: Vec<&Region> = order[step + 1..].iter().map(|&k| parts[k]).collect();
        let first = [parts[order[step]]];
        let goal = SplitGoal::of(&first, &others);
        let [first, remainder] = cut_in_two(&rest, &goal, MATCHED_CUTS, progress)?;
        pieces[order[step]] = Some(first);
        rest = remainder;
    }
    // `order` is not empty, because `parts` has at least two parts.
    pieces[order[order.len() - 1]] = Some(rest);
    pieces.into_iter().collect()
}

/// Bisects a region recursively into pieces for the parts in `order`.
fn bisect(
    region: Region,
    parts: &[&Region],
    order: &[usize],
    pieces: &mut [Option<Region>],
    progress: &dyn Progress,
) -> Option<()> {
    if let &[only] = order {
        pieces[only] = Some(region);
        return Some(());
    }
    let (first_half, second_half) = order.split_at(order.len() / 2);
    let selected = |order: &[usize]| order.iter().map(|&k| parts[k]).collect::<Vec<_>>();
    let (first_parts, other_parts) = (selected(first_half), selected(second_half));
    // If only one cut may be matched, `cut_in_two` returns the best-ranked cut without matching it.
    let goal = SplitGoal::of(&first_parts, &other_parts);
    let [first, rest] = cut_in_two(&region, &goal, 1, progress)?;
    bisect(first, parts, first_half, pieces, progress)?;
    bisect(rest, parts, second_half, pieces, progress)
}

/// Returns the direction of the line along which parts lie: the vector between the centres of the
/// two parts farthest apart, towards positive x.
fn main_direction(parts: &[&Region]) -> DVec2 {
    let mut best = DVec2::X;
    let mut max_squared = 0.0;
    for (k, a) in parts.iter().enumerate() {
        for b in &parts[k + 1..] {
            let apart = centre(b) - centre(a);
            if apart.length_squared() > max_squared {
                max_squared = apart.length_squared();
                best = if apart.x < 0.0 { -apart } else { apart };
            }
        }
    }
    best
}

/// Returns the centre of a region's bounding box.
fn centre(region: &Region) -> DVec2 {
    region.outer.bounds().centre()
}

/// The areas and positions of the two pieces that a cut should produce.
struct SplitGoal<'a> {
    /// Parts with which the first piece is to be matched.
    first: &'a [&'a Region],
    /// Parts with which the other piece is to be matched.
    others: &'a [&'a Region],
    /// Fraction of the region's area that the piece for `first` should get.
    share: f64,
    /// Vector from the centre of `first` to that of `others`, in units of the square root of their
    /// total area.
    apart: DVec2,
}

impl<'a> SplitGoal<'a> {
    fn of(first: &'a [&'a Region], others: &'a [&'a Region]) -> Self {
        let area = |parts: &[&Region]| parts.iter().map(|r| r.area()).sum::<f64>();
        let [first_area, other_area] = [area(first), area(others)];
        let middle_of = |parts: &[&Region], area: f64| -> DVec2 {
            parts.iter().map(|r| centre(r) * (r.area() / area)).sum()
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

/// Returns the two pieces of the best cut, first the piece for `goal.first`. `matched_cuts` is the
/// number of best-ranked cuts whose pieces are matched; with 1, the best-ranked cut is returned
/// without matching.
fn cut_in_two(
    region: &Region,
    goal: &SplitGoal,
    matched_cuts: usize,
    progress: &dyn Progress,
) -> Option<[Region; 2]> {
    let mut ranked: Vec<(f64, [Region; 2])> = Vec::new();
    for pieces in cuts(region, progress) {
        let [a, b] = &pieces.1;
        let (forward, swapped) = (rank(goal, a, b), rank(goal, b, a));
        let length_cost = LENGTH_WEIGHT * pieces.0 / region.area().sqrt();
        // Either piece may be the one for `goal.first`. Of the two assignments, take the one that
        // deviates less from the goal; `rank` returns this deviation.
        if forward <= swapped {
            ranked.push((forward + length_cost, pieces.1));
        } else {
            let [a, b] = pieces.1;
            ranked.push((swapped + length_cost, [b, a]));
        }
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked.truncate(matched_cuts);
    let rated = ranked.into_par_iter().map(|(rank, pieces)| {
        let cost = match matched_cuts {
            1 => rank,
            _ => match_cost(goal, &pieces, progress) + RANK_WEIGHT * rank,
        };
        (cost, pieces)
    });
    // Collect in order of rank, so that ties go to the better-ranked cut.
    let rated: Vec<(f64, [Region; 2])> = rated.collect();
    rated
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, pieces)| pieces)
}

/// Returns how much the areas and positions of two pieces deviate from the goal; lower is better.
fn rank(goal: &SplitGoal, first: &Region, rest: &Region) -> f64 {
    let total = first.area() + rest.area();
    let fraction = first.area() / total;
    let area_error =
        (fraction / goal.share).ln().abs() + ((1.0 - fraction) / (1.0 - goal.share)).ln().abs();
    let apart = (centre(rest) - centre(first)) / total.sqrt();
    AREA_WEIGHT * area_error + POSITION_WEIGHT * apart.distance(goal.apart)
}

/// Returns the cost of matching the two pieces with their parts, weighted by area. A piece for
/// several parts is not matched and costs 0.
fn match_cost(goal: &SplitGoal, [first, rest]: &[Region; 2], progress: &dyn Progress) -> f64 {
    let cost = |piece: &Region, part: &Region| {
        if progress.is_cancelled() {
            return f64::INFINITY;
        }
        let curves = [
            BoundaryCurve::closed(&piece.outer),
            BoundaryCurve::closed(&part.outer),
        ];
        let [Ok(a), Ok(b)] = curves else {
            return f64::INFINITY;
        };
        let options = coarse_options(&MatchOptions::default());
        match_curves(&a, &b, &[], &options).map_or(f64::INFINITY, |m| m.cost())
    };
    let single_cost = |weight: f64, piece: &Region, parts: &[&Region]| match parts {
        [part] => weight * cost(piece, part),
        _ => 0.0,
    };
    single_cost(goal.share, first, goal.first) + single_cost(1.0 - goal.share, rest, goal.others)
}

/// Returns the straight cuts between places of the outer boundary that stay inside the region, each
/// with its length and its two pieces; fewer if the work is cancelled.
fn cuts(region: &Region, progress: &dyn Progress) -> Vec<(f64, [Region; 2])> {
    let Ok(curve) = BoundaryCurve::closed(&region.outer) else {
        return Vec::new();
    };
    let place = |k: u32| {
        let fraction = f64::from(k) / f64::from(CUT_PLACES);
        BoundaryPlace {
            fraction,
            point: curve.point_at(fraction),
        }
    };
    let ends: Vec<BoundaryPlace> = (0..CUT_PLACES).map(place).collect();
    let cuts_from = |(k, from): (usize, &BoundaryPlace)| -> Vec<(f64, [Region; 2])> {
        let others = match progress.is_cancelled() {
            true => &[],
            false => &ends[k + 1..],
        };
        let cut = |to: &BoundaryPlace| {
            let pieces = cut_between(region, &curve, from, to)?;
            Some((from.point.distance(to.point), pieces))
        };
        others.iter().filter_map(cut).collect()
    };
    ends.par_iter()
        .enumerate()
        .flat_map_iter(cuts_from)
        .collect()
}

/// A place on the outer boundary at which a cut may end.
struct BoundaryPlace {
    /// Length along the boundary to the place, as a fraction of the boundary's length.
    fraction: f64,
    point: DVec2,
}

/// Cuts a region along the segment between two places of its outer boundary. Returns `None` if the
/// segment leaves the region, or a piece has no area.
fn cut_between(
    region: &Region,
    curve: &BoundaryCurve,
    from: &BoundaryPlace,
    to: &BoundaryPlace,
) -> Option<[Region; 2]> {
    let (a, b) = (from.point, to.point);
    if !is_free(region, a, b) {
        return None;
    }
    let between = |from: f64, to: f64| {
        let inner = curve.places().iter().zip(curve.points());
        inner.filter(move |(place, _)| from < **place && **place < to)
    };
    let mut first_side = vec![a];
    first_side.extend(between(from.fraction, to.fraction).map(|(_, p)| *p));
    first_side.push(b);
    let mut second_side = vec![b];
    second_side.extend(between(to.fraction, 2.0).map(|(_, p)| *p));
    second_side.extend(between(-1.0, from.fraction).map(|(_, p)| *p));
    second_side.push(a);
    let [Ok(first_side), Ok(second_side)] = [first_side, second_side].map(Ring::new) else {
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
    let pieces = [piece(first_side), piece(second_side)];
    pieces
        .iter()
        .all(|piece| piece.area() > 0.0)
        .then_some(pieces)
}

/// Returns whether the segment from `a` to `b`, without its ends, runs inside the region.
fn is_free(region: &Region, a: DVec2, b: DVec2) -> bool {
    /// Fraction of the segment omitted at each end, which lies on the boundary (tolerance: above
    /// rounding, far below any edge).
    const END_SHARE: f64 = 1e-6;
    let short = [a.lerp(b, END_SHARE), b.lerp(a, END_SHARE)];
    let mut edges = region.rings().flat_map(Ring::edges);
    region.contains(a.midpoint(b)) && !edges.any(|(p, q)| segments_touch(short, [p, q]))
}
