//! Schedule of the parts and holes that exist in only one design: the time window of each.
//!
//! A single such part looks best if it changes its size throughout the motion. If all do, they are
//! all half visible halfway: the turning of the outlines is that of both designs together, and the
//! area overshoots, or undershoots for holes. All time windows are therefore chosen together, such
//! that turning (the sum of absolute exterior angles) and area exceed those of the two designs as
//! little as possible ([`Rating::overshoot`](crate::measure::Rating::overshoot)). If a part
//! collides in its time window, it gets the next best one. The time windows of the following parts
//! are adapted to that choice.
//!
//! Guaranteed: swapping the designs reverses the time windows. Not guaranteed: that there is no
//! better schedule.

mod optimise;

use super::boundary_loops::SharedPartLoops;
use super::growth_profile::GrowthProfile;
use crate::content::TransientHole;
use crate::geometry::{
    Bounds, DVec2, Side, excess_variation, max_overshoot, signed_area, total_turning,
};
use crate::warp::{Arap, Placer, TimeWindow, Warp};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Number of equal steps of t over which the overshoot of turning and area is measured (resource
/// limit).
const STEPS: usize = 64;

/// Cost for each unit of t during which a part does not change its size. It is added to the
/// relative overshoot of turning and area beyond the two designs (heuristic).
const WAIT: f64 = 0.05;

/// Maximum additional cost of a schedule in which parts of a word appear and disappear in reading
/// order (heuristic).
const ORDERLY: f64 = 0.05;

/// Lengths, in units of t, of two extra time windows for a part that collides in every time window
/// that starts and ends at multiples of 1/8 (heuristic). The part visibly jumps, which is less bad
/// than a collision.
const JUMPS: [f64; 2] = [1.0 / 16.0, 1.0 / 32.0];
/// Additional cost of the time windows in [`JUMPS`]: once for the first, twice for the second
/// (heuristic).
const JUMP: f64 = 0.125;

/// Costs are rounded to multiples of this, so that the reversed motion gives the same schedule
/// (tolerance: above the rounding of the sums).
const GRAIN: f64 = 1e-9;

/// Returns a time window of length `long` that starts at t = 0 for a part of the source, and ends
/// at t = 1 for a part of the target.
pub(in crate::transition) fn life(side: Side, long: f64) -> TimeWindow {
    let whole = TimeWindow::whole(side);
    match side {
        Side::Source => TimeWindow { to: long, ..whole },
        Side::Target => TimeWindow {
            from: 1.0 - long,
            ..whole
        },
    }
}

/// Returns all time windows that start and end at multiples of 1/8, the longest first. Among
/// equally long ones, those nearest to the t of design `side` come first.
pub(in crate::transition) fn eighths(side: Side) -> impl Iterator<Item = TimeWindow> {
    let at = |eighths: u32| f64::from(eighths) / 8.0;
    let life = move |(long, kept): (u32, u32)| match side {
        Side::Source => TimeWindow {
            side,
            from: at(kept),
            to: at(kept + long),
        },
        Side::Target => TimeWindow {
            side,
            from: at(8 - kept - long),
            to: at(8 - kept),
        },
    };
    let all = (1..=8).rev();
    all.flat_map(|long| (0..=8 - long).map(move |kept| (long, kept)))
        .map(life)
}

/// A part or hole that exists in only one design.
#[derive(Clone)]
struct ScheduledTransient {
    growth: GrowthProfile,
    /// For a hole, at each t = k / [`STEPS`]: the area of the hole at full size, stretched by the
    /// motion, as a multiple of its area in its design. `None` for a part, which is not stretched.
    stretch: Option<Vec<f64>>,
    /// Centre of the part or hole in its design.
    place: DVec2,
    life: TimeWindow,
    /// Collision cost of each time window in [`eighths`]; empty if unknown.
    prices: Vec<f64>,
}

impl ScheduledTransient {
    /// Returns the cost of the time window without the overshoot of turning and area: the waiting
    /// time and the collisions.
    fn price(&self) -> f64 {
        let mut priced = eighths(self.life.side).zip(&self.prices);
        let price = priced.find(|(life, _)| *life == self.life);
        WAIT * wait(self.life) + price.map_or(0.0, |(_, price)| *price)
    }

    /// Returns the same part with another time window.
    fn within(&self, life: TimeWindow) -> Self {
        Self {
            life,
            ..self.clone()
        }
    }

    /// Adds the turning and the area of the part or hole, multiplied by `times`, to `sums`, which
    /// has an entry for each sampled t.
    fn add(&self, sums: &mut [[f64; 2]], times: f64) {
        let last = sums.len().saturating_sub(1) as f64;
        for (k, sum) in sums.iter_mut().enumerate() {
            let size = self.life.size(k as f64 / last);
            if size > 0.0 {
                let [turning, area] = self.growth.at_size(size);
                let stretch = self.stretch.as_ref().map_or(1.0, |stretch| stretch[k]);
                sum[0] += times * turning;
                sum[1] += times * area * stretch;
            }
        }
    }
}

/// Time windows of all parts and holes that exist in only one design: first the holes, then the
/// parts.
#[derive(Clone)]
pub(in crate::transition) struct TransientSchedule {
    coming: Vec<ScheduledTransient>,
    /// The turning and the area of everything that is drawn, at each t = k / [`STEPS`]; empty if
    /// the time windows are not optimised.
    sums: Vec<[f64; 2]>,
}

impl TransientSchedule {
    /// Creates a schedule in which each part or hole uses the longest time window in which it does
    /// not collide, regardless of the others.
    pub(in crate::transition) fn long(sides: impl Iterator<Item = Side>) -> Self {
        let coming = sides.map(|side| ScheduledTransient {
            growth: GrowthProfile::NONE,
            stretch: None,
            place: DVec2::ZERO,
            life: TimeWindow::whole(side),
            prices: Vec::new(),
        });
        Self {
            coming: coming.collect(),
            sums: Vec::new(),
        }
    }

    /// Creates a schedule to be optimised. It takes into account the turning and area of the
    /// matched parts of `film`. Each item of `parts` holds the design that has the part, the
    /// position of the part in that design, and its rings relative to that position.
    pub(in crate::transition) fn of<'a>(
        film: &Arap,
        holes: impl Iterator<Item = &'a TransientHole>,
        parts: impl Iterator<Item = (Side, DVec2, &'a [Vec<DVec2>])>,
    ) -> Self {
        let (holes, parts): (Vec<_>, Vec<_>) = (holes.collect(), parts.collect());
        let of_parts = parts.iter().map(|(_, _, rings)| rings.len());
        // A growth profile omits the full turn of each outline. The full turns of all transient
        // outlines are added here, even for times at which an outline is absent, so that the sum
        // does not jump when it appears.
        let points = TAU * (holes.len() + of_parts.sum::<usize>()) as f64;
        let diameter = film.mesh().diameter();
        let walks = SharedPartLoops::of(film);
        let at = |placer: &mut Placer, k: usize| -> ([f64; 2], Vec<f64>) {
            placer.place(k as f64 / STEPS as f64);
            let places = &placer.placement().in_frame;
            let rings = walks.rings(places);
            let area = rings.iter().map(|ring| signed_area(ring)).sum();
            let stretch = holes.iter().map(|hole| hole.area_ratio(places));
            (
                [total_turning(&rings, diameter) + points, area],
                stretch.collect(),
            )
        };
        let steps = (0..=STEPS).into_par_iter();
        let (sums, stretch): (Vec<[f64; 2]>, Vec<Vec<f64>>) =
            steps.map_init(|| film.placer(), at).unzip();
        let of_hole = |(k, hole): (usize, &&TransientHole)| ScheduledTransient {
            growth: GrowthProfile::of_scaling(std::slice::from_ref(hole.design_ring()), diameter),
            stretch: Some(stretch.iter().map(|at| at[k]).collect()),
            place: Bounds::of(hole.design_ring().iter().copied())
                .map_or(DVec2::ZERO, |b| b.centre()),
            life: TimeWindow::whole(hole.side()),
            prices: Vec::new(),
        };
        let of_part = |&(side, place, rings): &(Side, DVec2, &[Vec<DVec2>])| ScheduledTransient {
            growth: GrowthProfile::of_scaling(rings, diameter),
            stretch: None,
            place,
            life: TimeWindow::whole(side),
            prices: Vec::new(),
        };
        let coming = holes.iter().enumerate().map(of_hole);
        let coming = coming.chain(parts.iter().map(of_part)).collect();
        let mut all = Self { coming, sums };
        for coming in &all.coming {
            coming.add(&mut all.sums, 1.0);
        }
        all
    }

    /// Returns the time windows of the part or hole with index `k` in increasing order of cost,
    /// each with the amount by which it costs more than the cheapest. All other time windows are
    /// fixed. The current time window is made cheaper by [`ORDERLY`], so that the reading order is
    /// preserved. The short time windows in [`JUMPS`] come last.
    pub(in crate::transition) fn ranked(&self, k: usize) -> Vec<(f64, TimeWindow)> {
        let (now, mut ranked) = (self.coming[k].life, self.costs(k));
        for (cost, life) in &mut ranked {
            *cost -= if *life == now { ORDERLY } else { 0.0 };
        }
        ranked.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let [least, most] = [0, ranked.len() - 1].map(|k| ranked[k].0);
        let jumps = JUMPS.into_iter().enumerate();
        let jump = |(k, long)| (most + JUMP * (k + 1) as f64, life(now.side, long));
        ranked.extend(jumps.map(jump));
        ranked.iter_mut().for_each(|(cost, _)| *cost -= least);
        ranked
    }

    /// Returns the cost of each time window in [`eighths`] for the part or hole with index `k`,
    /// while all other time windows are fixed.
    fn costs(&self, k: usize) -> Vec<(f64, TimeWindow)> {
        let (coming, rest) = (&self.coming[k], self.without(k));
        let cost = |life| (cost(&coming.within(life), &rest), life);
        eighths(coming.life.side).map(cost).collect()
    }

    /// Returns by how much the cost increases if the part or hole with index `k` grows by the
    /// growth profile `growth` instead of its own, in the time window `life`; at least 0. A growth
    /// profile holds the turning and the area of the growing shape at each size.
    pub(in crate::transition) fn extra(
        &self,
        k: usize,
        life: TimeWindow,
        growth: GrowthProfile,
    ) -> f64 {
        let (coming, rest) = (self.coming[k].within(life), self.without(k));
        let plain = cost(&coming, &rest);
        (cost(&ScheduledTransient { growth, ..coming }, &rest) - plain).max(0.0)
    }

    /// Sets the time window of a part or hole.
    pub(in crate::transition) fn set(&mut self, k: usize, life: TimeWindow) {
        self.coming[k].add(&mut self.sums, -1.0);
        self.coming[k].life = life;
        self.coming[k].add(&mut self.sums, 1.0);
    }

    /// Sets the growth profile of a part or hole.
    pub(in crate::transition) fn set_growth(&mut self, k: usize, growth: GrowthProfile) {
        self.coming[k].add(&mut self.sums, -1.0);
        self.coming[k].growth = growth;
        self.coming[k].add(&mut self.sums, 1.0);
    }

    /// Returns the turning and the area of everything except one part or hole, at each sampled t.
    fn without(&self, k: usize) -> Vec<[f64; 2]> {
        let mut sums = self.sums.clone();
        self.coming[k].add(&mut sums, -1.0);
        sums
    }

    fn cost(&self) -> f64 {
        unrest(&self.sums)
            + self
                .coming
                .iter()
                .map(ScheduledTransient::price)
                .sum::<f64>()
    }
}

/// Returns the cost of a schedule, up to a constant: the price of one part or hole, plus the
/// overshoot of turning and area of everything that is drawn. `others` holds turning and area
/// without this part or hole, at each sampled t.
fn cost(coming: &ScheduledTransient, others: &[[f64; 2]]) -> f64 {
    let mut sums = others.to_vec();
    coming.add(&mut sums, 1.0);
    let cost = unrest(&sums) + coming.price();
    (cost / GRAIN).round() * GRAIN
}

/// Returns the fraction of the motion during which the part does not change its size.
fn wait(life: TimeWindow) -> f64 {
    1.0 - (life.to - life.from)
}

/// Returns the overshoot of the turning plus that of the area, each relative to the values at t = 0
/// and t = 1. `sums` holds turning and area at each sampled t.
fn unrest(sums: &[[f64; 2]]) -> f64 {
    if sums.is_empty() {
        return 0.0;
    }
    let last = (sums.len() - 1) as f64;
    let turned = sums.iter().enumerate();
    let turned: Vec<[f64; 2]> = turned
        .map(|(k, [turning, _])| [k as f64 / last, *turning])
        .collect();
    let areas = sums.iter().map(|[_, area]| *area);
    max_overshoot(&turned) + excess_variation(areas)
}

#[cfg(test)]
mod tests;
