//! Optimises the time windows of parts and holes that exist in only one design.
//!
//! Each of three starting schedules is improved by coordinate descent. In the best of them, the
//! time windows of the largest parts are then optimised in pairs. Letters of a word are finally
//! sorted into reading order.

use super::{GRAIN, ORDERLY, TransientSchedule, eighths, life};
use crate::geometry::{Bounds, DVec2, Side};
use crate::warp::TimeWindow;
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::ops::Range;

/// Maximum number of times that all time windows are optimised one after the other, and that all
/// pairs of time windows of the largest parts are optimised (resource limit).
const ROUNDS: u32 = 4;

/// Maximum number of passes that sort time windows into reading order (resource limit).
const MOST_READ: usize = 100;

/// Number of largest parts whose time windows are also optimised in pairs (heuristic).
const IN_TWOS: usize = 6;

/// Maximum number of time windows that are optimised; all others stay as they are (resource limit).
const PLANNED: usize = 1000;
/// Maximum number of parts or holes whose collision costs are computed (resource limit).
const PRICED: usize = 100;

impl TransientSchedule {
    /// Minimises the cost of the schedule over the time windows from index `fixed` on.
    ///
    /// `prices` returns the collision cost of each time window in [`eighths`] for a part, or an
    /// empty list if unknown.
    ///
    /// # Errors
    /// If the work is cancelled.
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

    /// Returns the best of the schedules reached from three starts: all time windows [0, 1];
    /// lengths proportional to the rank of the part; all lengths ¼. The time windows of the last
    /// two start at t = 0 for parts of the source and end at t = 1 for parts of the target.
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

    /// Returns a starting schedule. `long` returns the length of a time window from the part's rank
    /// among the parts of its design, as a fraction in (0, 1].
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

    /// Optimises one time window after the other until nothing improves, at most [`ROUNDS`] times.
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

    /// Returns the time window of a part with the lowest cost while all other time windows are
    /// fixed; the first of equally cheap ones.
    fn best_time(&self, k: usize) -> TimeWindow {
        let costs = self.costs(k).into_iter();
        let least = costs.min_by(|(a, _), (b, _)| a.total_cmp(b));
        least.map_or(self.coming[k].life, |(_, life)| life)
    }

    /// Optimises the time windows of the largest parts in pairs. Returns whether the cost
    /// decreased.
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

    /// Swaps time windows between the holes of a design, and between its parts, such that a word
    /// appears and disappears letter by letter, as long as the cost rises by at most [`ORDERLY`].
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
                // Each pass swaps neighbours, as in bubble sort.
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

    /// Sorts parts from left to right, or from top to bottom if the box around all of them is
    /// higher than wide.
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

    /// Swaps the time windows of two parts if the first part is then visible longer and the cost
    /// stays within `most`. Returns whether they were swapped.
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

/// Returns the fraction of the motion during which the part is absent.
pub(super) fn absence(life: TimeWindow) -> f64 {
    match life.side {
        Side::Source => 1.0 - life.to,
        Side::Target => life.from,
    }
}
