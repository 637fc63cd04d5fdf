//! The times in which a film is restless least.
//!
//! From several starts one after the other is changed as long as that helps, and then two of
//! the largest at a time; those of a word are put in the order in which it is read.

use super::{GRAIN, ORDERLY, TransientSchedule, eighths, life};
use crate::geometry::{Bounds, DVec2, Side};
use crate::warp::TimeWindow;
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::ops::Range;

/// How often all are gone through.
const ROUNDS: u32 = 4;

/// How many are put in order at most.
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

impl TransientSchedule {
    /// Chooses the times in which a film is restless least, but for the first ones, which have
    /// theirs, and for those after the most that are planned. Each time costs what `prices`
    /// says, if anything, for what is in the way in it.
    pub(in crate::transition) fn plan(
        &mut self,
        fixed: usize,
        prices: impl Fn(usize) -> Vec<f64>,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        if self.sums.is_empty() {
            return Ok(());
        }
        for k in (fixed..self.coming.len()).take(PRICED) {
            check_cancelled(progress)?;
            self.coming[k].prices = prices(k);
        }
        let free = fixed..self.coming.len().min(fixed + PLANNED);
        *self = self.settled(&free).in_order(&free);
        for coming in &mut self.coming {
            coming.prices.clear();
        }
        Ok(())
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

    pub(super) fn improved(mut self, free: &Range<usize>) -> Self {
        for _ in 0..ROUNDS {
            let mut is_better = false;
            for k in free.clone() {
                let life = self.best_time(k);
                is_better |= life != self.coming[k].life;
                self.set(k, life);
            }
            if !is_better {
                break;
            }
        }
        self
    }

    /// The first of the times that cost one of them least, while the others keep theirs.
    fn best_time(&self, k: usize) -> TimeWindow {
        let costs = self.costs(k).into_iter();
        let least = costs.min_by(|(a, _), (b, _)| a.total_cmp(b));
        least.map_or(self.coming[k].life, |(_, life)| life)
    }

    /// Changes the times of two of the largest at once, where that helps, and says whether it
    /// did.
    pub(super) fn improve_twos(&mut self, free: &Range<usize>) -> bool {
        let size = |k: usize| self.coming[k].growth.at_size(1.0)[1].abs();
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
                    next.set(b, next.best_time(b));
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
}

/// The share of the film in which it is not there.
pub(super) fn absence(life: TimeWindow) -> f64 {
    match life.side {
        Side::Source => 1.0 - life.to,
        Side::Target => life.from,
    }
}
