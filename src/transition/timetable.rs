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
//! are no better ones; one after the other is changed as long as that helps, and then two of
//! the largest at a time.

use super::growth::Growth;
use super::walks::Walks;
use crate::content::Hole;
use crate::geometry::{
    Bounds, DVec2, Side, excess_between, signed_area, turning, variation_excess,
};
use crate::warp::{Arap, Life, Placer, Warp};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Even steps at which unrest is looked at.
const STEPS: usize = 64;

/// How often all are gone through.
const ROUNDS: u32 = 4;

/// What it costs to wait for the whole film, against turning or area beyond the ends by all
/// of what they need. With twice as much the worst tenth of the turning of 60 pairs of icons is 0.14
/// instead of 0.13, with four times 0.24; with a fifth the area of one pair more runs by
/// more than a fifth.
const WAIT: f64 = 0.05;

/// What it may cost that all come and go in order, and how many are put in order at most.
/// Without it, of a plate that says SRG SSR the G goes first, then the second S, the last R.
const ORDERLY: f64 = 0.05;
const MOST_READ: usize = 100;

/// Of how many all pairs are looked at. With none the worst tenth of the area of 60 pairs of
/// icons is 0.22 instead of 0.20; with four it is the same, but two of 60 other pairs run by
/// 0.05 and 0.09 more.
const IN_TWOS: usize = 6;

/// How many are planned at most, and for how many of them it is found out what is in their way:
/// were it for none, the worst tenth of the area of 60 pairs of icons would be 0.25 instead of
/// 0.20. Of 40,000 holes nobody sees when each comes.
const PLANNED: usize = 1000;
const PRICED: usize = 100;

/// Times are chosen among eighths of the film. What would meet something in all of them may
/// take shorter ones, each for this more: it is seen to jump, which is less bad. Were they
/// chosen for calm, a wave within headphones would be there all at once, at the end.
const JUMPS: [f64; 2] = [1.0 / 16.0, 1.0 / 32.0];
const JUMP: f64 = 0.125;

/// What costs less than this apart costs the same: sums are rounded otherwise in the film run
/// backwards.
const GRAIN: f64 = 1e-9;

/// So much of the film, from the end where the design is that has what changes its size.
pub(super) fn life(side: Side, long: f64) -> Life {
    let whole = Life::whole(side);
    match side {
        Side::Source => Life { to: long, ..whole },
        Side::Target => Life {
            from: 1.0 - long,
            ..whole
        },
    }
}

/// The times that are chosen from, the longest first, and of equally long ones first that
/// which begins or ends the film. Were there only those, the worst tenth of the area of 60
/// pairs of icons would be 0.26 instead of 0.20.
pub(super) fn eighths(side: Side) -> impl Iterator<Item = Life> {
    let at = |eighths: u32| f64::from(eighths) / 8.0;
    let life = move |(long, kept): (u32, u32)| match side {
        Side::Source => Life {
            side,
            from: at(kept),
            to: at(kept + long),
        },
        Side::Target => Life {
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
struct Coming {
    growth: Growth,
    /// By how much a hole's area is larger than in its design for what it is in being
    /// larger, at each step; nothing stretches a part.
    stretch: Option<Vec<f64>>,
    /// Where its middle is in its design.
    place: DVec2,
    life: Life,
    /// What each of the times costs that are chosen from, for what is in its way; nothing
    /// does where that is not known.
    prices: Vec<f64>,
}

impl Coming {
    /// What its time costs by itself.
    fn price(&self) -> f64 {
        let mut priced = eighths(self.life.side).zip(&self.prices);
        let price = priced.find(|(life, _)| *life == self.life);
        WAIT * wait(self.life) + price.map_or(0.0, |(_, price)| *price)
    }

    /// The same in another time.
    fn within(&self, life: Life) -> Self {
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
                let [turning, area] = self.growth.at(size);
                let stretch = self.stretch.as_ref().map_or(1.0, |stretch| stretch[k]);
                sum[0] += times * turning;
                sum[1] += times * area * stretch;
            }
        }
    }
}

/// Times of all that comes and goes, first of holes and then of parts.
#[derive(Clone)]
pub(super) struct Timetable {
    coming: Vec<Coming>,
    /// Turning and area of all there is, at each step; of nothing where each takes as long
    /// as it can.
    sums: Vec<[f64; 2]>,
}

impl Timetable {
    /// In which each takes as long as it can, whatever the others do.
    pub(super) fn long(sides: impl Iterator<Item = Side>) -> Self {
        let coming = sides.map(|side| Coming {
            growth: Growth::NONE,
            stretch: None,
            place: DVec2::ZERO,
            life: Life::whole(side),
            prices: Vec::new(),
        });
        Self {
            coming: coming.collect(),
            sums: Vec::new(),
        }
    }

    /// The same, with what the film has beside them, for times to be planned. Parts are the
    /// designs that have them, where, and their rings there.
    pub(super) fn of<'a>(
        film: &Arap,
        holes: impl Iterator<Item = &'a Hole>,
        parts: impl Iterator<Item = (Side, DVec2, &'a [Vec<DVec2>])>,
    ) -> Self {
        let (holes, parts): (Vec<_>, Vec<_>) = (holes.collect(), parts.collect());
        let of_parts = parts.iter().map(|(_, _, rings)| rings.len());
        // What is gone is a point to what counts outlines.
        let points = TAU * (holes.len() + of_parts.sum::<usize>()) as f64;
        let diameter = film.mesh().diameter();
        let walks = Walks::of(film);
        let at = |placer: &mut Placer, k: usize| -> ([f64; 2], Vec<f64>) {
            placer.place(k as f64 / STEPS as f64);
            let places = &placer.placement().in_frame;
            let rings = walks.rings(places);
            let area = rings.iter().map(|ring| signed_area(ring)).sum();
            let stretch = holes.iter().map(|hole| hole.stretch(places));
            (
                [turning(&rings, diameter) + points, area],
                stretch.collect(),
            )
        };
        let steps = (0..=STEPS).into_par_iter();
        let (sums, stretch): (Vec<[f64; 2]>, Vec<Vec<f64>>) =
            steps.map_init(|| film.placer(), at).unzip();
        let of_hole = |(k, hole): (usize, &&Hole)| Coming {
            growth: Growth::scaled(std::slice::from_ref(hole.ring()), diameter),
            stretch: Some(stretch.iter().map(|at| at[k]).collect()),
            place: Bounds::of(hole.ring().iter().copied()).map_or(DVec2::ZERO, |b| b.centre()),
            life: Life::whole(hole.side()),
            prices: Vec::new(),
        };
        let of_part = |&(side, place, rings): &(Side, DVec2, &[Vec<DVec2>])| Coming {
            growth: Growth::scaled(rings, diameter),
            stretch: None,
            place,
            life: Life::whole(side),
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

    /// Chooses the times in which a film is restless least, but for the first ones, which have
    /// theirs, and for those after the most that are planned. Each time costs what `prices`
    /// says, if anything, for what is in the way in it.
    pub(super) fn plan(&mut self, fixed: usize, prices: impl Fn(usize) -> Vec<f64>) {
        if self.sums.is_empty() {
            return;
        }
        for k in (fixed..self.coming.len()).take(PRICED) {
            self.coming[k].prices = prices(k);
        }
        let free = fixed..self.coming.len().min(fixed + PLANNED);
        *self = self.settled(&free).in_order(&free);
        for coming in &mut self.coming {
            coming.prices.clear();
        }
    }

    /// The best that is found from several starts: all of them all the time, one after
    /// the other, all at their own ends. From the first alone the worst tenth of the
    /// turning of 60 pairs of icons is 0.17 instead of 0.13.
    fn settled(&self, free: &Range<usize>) -> Self {
        let mut best = self.started(free, |_| 1.0).improved(free);
        let others: [&dyn Fn(f64) -> f64; 2] = [&|share| share, &|_| 0.25];
        for long in others {
            let next = self.started(free, long).improved(free);
            if next.cost() < best.cost() - GRAIN {
                best = next;
            }
        }
        for _ in 0..ROUNDS {
            if !best.improve_twos(free) {
                break;
            }
            best = best.improved(free);
        }
        best
    }

    /// In which each takes so much of the film by its share in the order of those of its
    /// design.
    fn started(&self, free: &Range<usize>, long: impl Fn(f64) -> f64) -> Self {
        let mut all = self.clone();
        for side in Side::BOTH {
            let of_side = |&k: &usize| self.coming[k].life.side == side;
            let of_side: Vec<usize> = free.clone().filter(of_side).collect();
            for (rank, &k) in of_side.iter().enumerate() {
                let long = long((rank + 1) as f64 / of_side.len() as f64);
                all.set(k, life(side, (8.0 * long).ceil() / 8.0));
            }
        }
        all
    }

    fn improved(mut self, free: &Range<usize>) -> Self {
        for _ in 0..ROUNDS {
            let mut is_better = false;
            for k in free.clone() {
                let costs = self.costs(k).into_iter();
                let least = costs.min_by(|(a, _), (b, _)| a.total_cmp(b));
                let life = least.map_or(self.coming[k].life, |(_, life)| life);
                is_better |= life != self.coming[k].life;
                self.set(k, life);
            }
            if !is_better {
                break;
            }
        }
        self
    }

    /// Changes the times of two of the largest at once, where that helps, and says whether it
    /// did.
    fn improve_twos(&mut self, free: &Range<usize>) -> bool {
        let size = |k: usize| self.coming[k].growth.at(1.0)[1].abs();
        let mut largest: Vec<usize> = free.clone().collect();
        largest.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
        largest.truncate(IN_TWOS);
        let mut is_better = false;
        for (k, &a) in largest.iter().enumerate() {
            for &b in &largest[k + 1..] {
                let (now, mut best) = (self.cost(), self.clone());
                for life in eighths(self.coming[a].life.side) {
                    let mut next = self.clone();
                    next.set(a, life);
                    let costs = next.costs(b).into_iter();
                    let Some((_, life)) = costs.min_by(|(a, _), (b, _)| a.total_cmp(b)) else {
                        continue;
                    };
                    next.set(b, life);
                    if next.cost() < best.cost() - GRAIN {
                        best = next;
                    }
                }
                is_better |= best.cost() < now - GRAIN;
                *self = best;
            }
        }
        is_better
    }

    /// The times of the holes of a design, and those of its parts, exchanged so that a word is
    /// written and taken back letter by letter, where all of that costs little.
    fn in_order(mut self, free: &Range<usize>) -> Self {
        let most = self.cost() + ORDERLY;
        for side in Side::BOTH {
            for are_holes in [true, false] {
                let is_one = |k: &usize| {
                    let coming = &self.coming[*k];
                    (coming.life.side, coming.stretch.is_some()) == (side, are_holes)
                };
                let some: Vec<usize> = free.clone().filter(is_one).collect();
                let read = self.as_read(some);
                // Those that are exchanged come next to others.
                for _ in 0..read.len().min(MOST_READ) {
                    let pairs = read.windows(2);
                    if pairs.filter(|pair| self.exchange(pair, most)).count() == 0 {
                        break;
                    }
                }
            }
        }
        self
    }

    /// Some from left to right, or downwards where together they are higher than wide.
    fn as_read(&self, mut some: Vec<usize>) -> Vec<usize> {
        let places = some.iter().map(|&k| self.coming[k].place);
        let size = Bounds::of(places).map_or(DVec2::ZERO, |bounds| bounds.size());
        let along = |k: usize| {
            let place = self.coming[k].place;
            if size.x >= size.y { place.x } else { -place.y }
        };
        some.sort_by(|&a, &b| along(a).total_cmp(&along(b)));
        some
    }

    /// Lets the first of two be there longer, if all then costs `most` at most.
    fn exchange(&mut self, pair: &[usize], most: f64) -> bool {
        let [a, b] = [0, 1].map(|k| self.coming[pair[k]].life);
        if absence(a) <= absence(b) {
            return false;
        }
        self.set(pair[0], b);
        self.set(pair[1], a);
        let is_cheap = self.cost() <= most;
        if !is_cheap {
            self.set(pair[0], a);
            self.set(pair[1], b);
        }
        is_cheap
    }

    /// What each of the times costs one of them beyond the least of them, the least first,
    /// while the others keep theirs. The time that it has counts less, by what the order
    /// may cost.
    pub(super) fn ranked(&self, k: usize) -> Vec<(f64, Life)> {
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
    fn costs(&self, k: usize) -> Vec<(f64, Life)> {
        let (coming, rest) = (&self.coming[k], self.without(k));
        let cost = |life| (cost(&coming.within(life), &rest), life);
        eighths(coming.life.side).map(cost).collect()
    }

    /// What it costs more that one of them grows in another way in one of the times.
    pub(super) fn extra(&self, k: usize, life: Life, growth: Growth) -> f64 {
        let (coming, rest) = (self.coming[k].within(life), self.without(k));
        let plain = cost(&coming, &rest);
        (cost(&Coming { growth, ..coming }, &rest) - plain).max(0.0)
    }

    /// One has got its time.
    pub(super) fn set(&mut self, k: usize, life: Life) {
        self.coming[k].add(&mut self.sums, -1.0);
        self.coming[k].life = life;
        self.coming[k].add(&mut self.sums, 1.0);
    }

    /// And grows in another way.
    pub(super) fn set_growth(&mut self, k: usize, growth: Growth) {
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
        unrest(&self.sums) + self.coming.iter().map(Coming::price).sum::<f64>()
    }
}

/// What it costs that one is there beside all others.
fn cost(coming: &Coming, others: &[[f64; 2]]) -> f64 {
    let mut sums = others.to_vec();
    coming.add(&mut sums, 1.0);
    let cost = unrest(&sums) + coming.price();
    (cost / GRAIN).round() * GRAIN
}

/// The share of the film in which it does not change.
fn wait(life: Life) -> f64 {
    1.0 - (life.to - life.from)
}

/// The share of the film in which it is not there.
fn absence(life: Life) -> f64 {
    match life.side {
        Side::Source => 1.0 - life.to,
        Side::Target => life.from,
    }
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
    excess_between(&turned) + variation_excess(areas)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It turns much more than what is convex does.
    fn comb(x: f64) -> Vec<DVec2> {
        let mut ring: Vec<DVec2> = (0..=16)
            .map(|k| DVec2::new(f64::from(k) / 16.0, f64::from(k % 2)))
            .collect();
        ring.extend([DVec2::new(1.0, -1.0), DVec2::new(0.0, -1.0)]);
        ring.iter_mut().for_each(|p| p.x += x);
        ring.reverse();
        ring
    }

    /// Combs of these designs, side by side, beside something that stays as it is.
    fn combs(sides: &[Side]) -> Timetable {
        let coming = |(x, &side): (usize, &Side)| Coming {
            growth: Growth::scaled(&[comb(x as f64)], 10.0),
            stretch: None,
            place: DVec2::X * x as f64,
            life: Life::whole(side),
            prices: Vec::new(),
        };
        let coming: Vec<Coming> = sides.iter().enumerate().map(coming).collect();
        let sums = vec![[TAU * 10.0, 20.0]; STEPS + 1];
        let mut all = Timetable { coming, sums };
        for coming in &all.coming {
            coming.add(&mut all.sums, 1.0);
        }
        all
    }

    fn lives(timetable: &Timetable) -> Vec<Life> {
        timetable.coming.iter().map(|coming| coming.life).collect()
    }

    /// The same, with times that are planned; nothing is in the way of anything.
    fn planned(mut all: Timetable) -> Timetable {
        all.plan(0, |_| Vec::new());
        all
    }

    #[test]
    fn what_goes_makes_room_for_what_comes() {
        let sides = [Side::Source, Side::Target, Side::Source, Side::Target];
        let whole = combs(&sides);
        let calm = planned(whole.clone());
        let [before, after] = [&whole, &calm].map(|all| unrest(&all.sums));
        assert!(after < 0.7 * before, "{after} instead of {before}");
        assert_eq!(planned(combs(&[])).cost(), 0.0);
    }

    #[test]
    fn a_word_is_taken_back_and_written_from_its_end_and_beginning() {
        let times = |side| {
            let ordered = planned(combs(&[side; 6]));
            let lives = lives(&ordered).into_iter();
            lives.map(absence).collect::<Vec<f64>>()
        };
        for side in Side::BOTH {
            let absences = times(side);
            assert!(absences.is_sorted(), "{absences:?}");
            assert!(absences[0] < absences[5], "{absences:?}");
        }
    }

    #[test]
    fn designs_exchanged_give_the_times_reversed() {
        let sides = [
            Side::Source,
            Side::Source,
            Side::Target,
            Side::Source,
            Side::Target,
        ];
        let there = lives(&planned(combs(&sides)));
        let back = lives(&planned(combs(&sides.map(Side::other))));
        let reversed: Vec<Life> = back.into_iter().map(Life::backwards).collect();
        assert_eq!(there, reversed);
    }

    #[test]
    fn times_that_are_not_free_are_planned_around() {
        let sides = [Side::Source, Side::Target, Side::Target];
        // What comes may do so in the last quarter only, and what goes has its time.
        let price = |life: Life| f64::from(u8::from(life.from < 0.75));
        let mut all = combs(&sides);
        all.set(0, life(Side::Source, 0.5));
        all.plan(1, |k| eighths(sides[k]).map(price).collect());
        let lives = lives(&all);
        assert_eq!(lives[0], life(Side::Source, 0.5));
        assert!(lives[1..].iter().all(|life| life.from >= 0.75), "{lives:?}");
        // Nothing is dear any more.
        assert!(all.costs(1).iter().all(|(cost, _)| *cost < 1.0));
    }

    #[test]
    fn two_change_places_where_neither_can_alone() {
        let mut all = combs(&[Side::Source, Side::Target]);
        let mut take = |[first, second]: [f64; 2]| {
            all.set(0, life(Side::Source, first));
            all.set(1, life(Side::Target, second));
            all.cost()
        };
        // Either may take a quarter or three, and it is dear for the second to be long; less
        // so than for both to be short, or long.
        let [short, long, now] = [[0.25, 0.25], [0.75, 0.75], [0.25, 0.75]].map(&mut take);
        let dear = (short.min(long) - now) / 2.0;
        assert!(dear > 0.01, "{dear}");
        let price = |life: Life, dear: f64| match life.to - life.from {
            0.25 => 0.0,
            0.75 => dear,
            _ => 1.0,
        };
        for (k, dear) in [0.0, dear].into_iter().enumerate() {
            let times = eighths(all.coming[k].life.side);
            all.coming[k].prices = times.map(|life| price(life, dear)).collect();
        }
        let mut all = all.improved(&(0..2));
        assert_eq!(all.coming[1].life, life(Side::Target, 0.75));
        assert!(all.improve_twos(&(0..2)));
        assert_eq!(all.coming[1].life, life(Side::Target, 0.25));
        assert_eq!(all.coming[0].life, life(Side::Source, 0.75));
        assert!(!all.improve_twos(&(0..2)));
    }

    #[test]
    fn any_eighths_of_the_film_are_times() {
        for side in Side::BOTH {
            let times: Vec<Life> = eighths(side).collect();
            assert_eq!(times.len(), 36);
            assert!(
                times
                    .iter()
                    .all(|life| life.is_sound() && life.side == side)
            );
            assert_eq!(times[0], Life::whole(side));
            let back = eighths(side.other()).map(Life::backwards);
            assert!(back.eq(times));
        }
    }

    #[test]
    fn one_that_gets_another_time_is_known_of_by_the_others() {
        let mut all = planned(combs(&[Side::Source, Side::Target]));
        let before = all.costs(1);
        all.set(0, life(Side::Source, 1.0));
        assert_ne!(all.costs(1), before);
        // Times that jump come last, whatever they would save.
        let ranked = all.ranked(1);
        let times = eighths(Side::Target).count();
        assert_eq!(ranked.len(), times + JUMPS.len());
        assert_eq!(ranked[0].0, 0.0);
        assert!(ranked.is_sorted_by(|a, b| a.0 <= b.0));
        assert!(wait(ranked[times + 1].1) > wait(ranked[times].1));
    }
}
