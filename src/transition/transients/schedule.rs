//! When what one design has alone comes and goes.
//!
//! By itself each would take the whole film, which is calmest. All at once they are there
//! together halfway: outlines turn as much as those of both designs together, and the area
//! runs up with them, or down where they are holes. So their times are chosen together,
//! for the film to be restless least, as [`Rating::unrest`](crate::measure::Rating::unrest)
//! has it, among those that what both designs have leaves free. What then meets something
//! else in its time takes the next best, and those that come after it know.
//!
//! Guaranteed: exchanging the designs gives the times reversed. Not guaranteed: that there
//! are no better ones.

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

/// Even steps at which unrest is looked at.
const STEPS: usize = 64;

/// What it costs to wait for the whole film, against turning or area beyond the ends by all
/// of what they need. With twice as much the worst tenth of the turning of 60 pairs of icons
/// is 0.14 instead of 0.13, with four times 0.24; with a fifth the area of one pair more runs
/// by more than a fifth.
const WAIT: f64 = 0.05;

/// What it may cost that all come and go in order. Without it, of a plate that says SRG SSR
/// the G goes first, then the second S, the last R.
const ORDERLY: f64 = 0.05;

/// Times are chosen among eighths of the film. What would meet something in all of them may
/// take shorter ones, each for this more: it is seen to jump, which is less bad. Were they
/// chosen for calm, a wave within headphones would be there all at once, at the end.
const JUMPS: [f64; 2] = [1.0 / 16.0, 1.0 / 32.0];
const JUMP: f64 = 0.125;

/// What costs less than this apart costs the same: sums are rounded otherwise in the film run
/// backwards.
const GRAIN: f64 = 1e-9;

/// So much of the film, from the end where the design is that has what changes its size.
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

/// The times that are chosen from, the longest first, and of equally long ones first that
/// which begins or ends the film. Were there only those, the worst tenth of the area of 60
/// pairs of icons would be 0.26 instead of 0.20.
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

/// What comes or goes.
#[derive(Clone)]
struct ScheduledTransient {
    growth: GrowthProfile,
    /// By how much a hole's area is larger than in its design for what it is in being
    /// larger, at each step; nothing stretches a part.
    stretch: Option<Vec<f64>>,
    /// Where its middle is in its design.
    place: DVec2,
    life: TimeWindow,
    /// What each of the times costs that are chosen from, for what is in its way; nothing
    /// does where that is not known.
    prices: Vec<f64>,
}

impl ScheduledTransient {
    /// What its time costs by itself.
    fn price(&self) -> f64 {
        let mut priced = eighths(self.life.side).zip(&self.prices);
        let price = priced.find(|(life, _)| *life == self.life);
        WAIT * wait(self.life) + price.map_or(0.0, |(_, price)| *price)
    }

    /// The same in another time.
    fn within(&self, life: TimeWindow) -> Self {
        Self {
            life,
            ..self.clone()
        }
    }

    /// Adds its turning and area to those at each step, so often.
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

/// Times of all that comes and goes, first of holes and then of parts.
#[derive(Clone)]
pub(in crate::transition) struct TransientSchedule {
    coming: Vec<ScheduledTransient>,
    /// Turning and area of all there is, at each step; of nothing where each takes as long
    /// as it can.
    sums: Vec<[f64; 2]>,
}

impl TransientSchedule {
    /// In which each takes as long as it can, whatever the others do.
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

    /// The same, with what the film has beside them, for times to be planned. Parts are the
    /// designs that have them, where, and their rings there.
    pub(in crate::transition) fn of<'a>(
        film: &Arap,
        holes: impl Iterator<Item = &'a TransientHole>,
        parts: impl Iterator<Item = (Side, DVec2, &'a [Vec<DVec2>])>,
    ) -> Self {
        let (holes, parts): (Vec<_>, Vec<_>) = (holes.collect(), parts.collect());
        let of_parts = parts.iter().map(|(_, _, rings)| rings.len());
        // What is gone is a point to what counts outlines.
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

    /// What each of the times costs one of them beyond the least of them, the least first,
    /// while the others keep theirs. The time that it has counts less, by what the order
    /// may cost.
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

    /// What each of the times costs one of them, the longest first.
    fn costs(&self, k: usize) -> Vec<(f64, TimeWindow)> {
        let (coming, rest) = (&self.coming[k], self.without(k));
        let cost = |life| (cost(&coming.within(life), &rest), life);
        eighths(coming.life.side).map(cost).collect()
    }

    /// What it costs more that one of them grows in another way in one of the times.
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

    /// One has got its time.
    pub(in crate::transition) fn set(&mut self, k: usize, life: TimeWindow) {
        self.coming[k].add(&mut self.sums, -1.0);
        self.coming[k].life = life;
        self.coming[k].add(&mut self.sums, 1.0);
    }

    /// And grows in another way.
    pub(in crate::transition) fn set_growth(&mut self, k: usize, growth: GrowthProfile) {
        self.coming[k].add(&mut self.sums, -1.0);
        self.coming[k].growth = growth;
        self.coming[k].add(&mut self.sums, 1.0);
    }

    /// Turning and area at each step of all but one.
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

/// What it costs that one is there beside all others.
fn cost(coming: &ScheduledTransient, others: &[[f64; 2]]) -> f64 {
    let mut sums = others.to_vec();
    coming.add(&mut sums, 1.0);
    let cost = unrest(&sums) + coming.price();
    (cost / GRAIN).round() * GRAIN
}

/// The share of the film in which it does not change.
fn wait(life: TimeWindow) -> f64 {
    1.0 - (life.to - life.from)
}

/// Turning and area beyond what the ends need, as shares.
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
