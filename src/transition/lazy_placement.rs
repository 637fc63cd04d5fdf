//! A placement that is brought up to its t when somebody reads it.
//!
//! What a graphics card plays is seldom read by the processor, and placing a million
//! vertices that nobody reads costs as much as placing those that somebody does.
//!
//! Guarantees: whoever reads it gets the placement at the last t, from any number of
//! threads; nothing is allocated, whether it is read or not.

use crate::warp::{Placement, Placer};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A placer and the t that it is wanted at.
#[derive(Debug)]
pub(super) struct LazyPlacement {
    t: f64,
    /// Where the placer is while it is at t.
    placed: OnceLock<Placer>,
    /// Where it is while it is elsewhere.
    waiting: Mutex<Option<Placer>>,
}

impl LazyPlacement {
    /// Not placed yet.
    pub(super) fn new(placer: Placer, t: f64) -> Self {
        Self {
            t,
            placed: OnceLock::new(),
            waiting: Mutex::new(Some(placer)),
        }
    }

    pub(super) fn t(&self) -> f64 {
        self.t
    }

    /// Wants it at `t`.
    pub(super) fn turn(&mut self, t: f64) {
        self.t = t;
        if let Some(placer) = self.placed.take() {
            let waiting = self.waiting.get_mut();
            *waiting.unwrap_or_else(PoisonError::into_inner) = Some(placer);
        }
    }

    /// The placement at t. Should a warp panic while it places, which none does, the
    /// placer is lost with it: then it is made `anew`.
    pub(super) fn placement(&self, anew: impl FnOnce() -> Placer) -> &Placement {
        let placer = self.placed.get_or_init(|| {
            let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
            let placer = waiting.take();
            drop(waiting);
            let mut placer = placer.unwrap_or_else(anew);
            placer.place(self.t);
            placer
        });
        placer.placement()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// One vertex that is at (t, 0), and how often it was placed.
    fn counted() -> (LazyPlacement, Arc<AtomicUsize>) {
        let count = Arc::new(AtomicUsize::new(0));
        let counter = Arc::clone(&count);
        let placement = Placement::of_source(Arc::from([]), &[DVec2::ZERO], &[DVec2::ZERO]);
        let placer = Placer::new(placement, move |t, placement| {
            counter.fetch_add(1, Ordering::Relaxed);
            placement.in_frame[0] = DVec2::new(t, 0.0);
        });
        (LazyPlacement::new(placer, 0.25), count)
    }

    fn x(lazy: &LazyPlacement) -> f64 {
        let placement = lazy.placement(|| unreachable!("it has its placer"));
        placement.in_frame[0].x
    }

    #[test]
    fn it_is_placed_once_for_each_t_that_is_read_and_for_no_other() {
        let (mut lazy, count) = counted();
        assert_eq!([x(&lazy), x(&lazy)], [0.25; 2]);
        for t in [0.5, 0.75, 1.0] {
            lazy.turn(t);
            assert_eq!(lazy.t(), t);
        }
        assert_eq!(count.load(Ordering::Relaxed), 1);
        assert_eq!(x(&lazy), 1.0);
        assert_eq!(count.load(Ordering::Relaxed), 2);
    }

    #[test]
    fn whoever_reads_at_the_same_time_sees_the_same() {
        let (mut lazy, count) = counted();
        lazy.turn(0.5);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| assert_eq!(x(&lazy), 0.5));
            }
        });
        assert_eq!(count.load(Ordering::Relaxed), 1);
    }
}
