//! A placement that is only computed when it is read.
//!
//! The CPU seldom reads the vertices of frames that the graphics card plays, and placing a million
//! vertices takes time even if they are not read.
//!
//! Guaranteed: every reader, on any thread, gets the placement at the last t that was set. Neither
//! setting t nor reading allocates memory.

use crate::warp::{Placement, Placer};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A placer and the t at which its placement is to be returned.
#[derive(Debug)]
pub(super) struct LazyPlacement {
    t: f64,
    /// Holds the placer if its vertices are placed at `t`; empty otherwise.
    current: OnceLock<Placer>,
    /// Holds the placer if its vertices are not yet placed at `t`; `None` otherwise.
    outdated: Mutex<Option<Placer>>,
}

impl LazyPlacement {
    /// Wraps a placer without placing its vertices.
    pub(super) fn new(placer: Placer, t: f64) -> Self {
        Self {
            t,
            current: OnceLock::new(),
            outdated: Mutex::new(Some(placer)),
        }
    }

    /// Returns the t of the placement.
    pub(super) fn t(&self) -> f64 {
        self.t
    }

    /// Sets t, which invalidates the placement.
    pub(super) fn set_time(&mut self, t: f64) {
        self.t = t;
        if let Some(placer) = self.current.take() {
            let waiting = self.outdated.get_mut();
            *waiting.unwrap_or_else(PoisonError::into_inner) = Some(placer);
        }
    }

    /// Returns the placement at t. `make_placer` is only called if an earlier evaluation panicked
    /// and its placer was lost.
    pub(super) fn placement(&self, make_placer: impl FnOnce() -> Placer) -> &Placement {
        let placer = self.current.get_or_init(|| {
            let mut waiting = self.outdated.lock().unwrap_or_else(PoisonError::into_inner);
            let placer = waiting.take();
            drop(waiting);
            let mut placer = placer.unwrap_or_else(make_placer);
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

    /// Returns a placement of one vertex at (t, 0), and the number of times that it was placed.
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
    fn vertices_are_placed_once_for_each_t_that_is_read() {
        let (mut lazy, count) = counted();
        assert_eq!([x(&lazy), x(&lazy)], [0.25; 2]);
        for t in [0.5, 0.75, 1.0] {
            lazy.set_time(t);
            assert_eq!(lazy.t(), t);
        }
        assert_eq!(count.load(Ordering::Relaxed), 1);
        assert_eq!(x(&lazy), 1.0);
        assert_eq!(count.load(Ordering::Relaxed), 2);
    }

    #[test]
    fn concurrent_readers_see_the_same_placement() {
        let (mut lazy, count) = counted();
        lazy.set_time(0.5);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| assert_eq!(x(&lazy), 0.5));
            }
        });
        assert_eq!(count.load(Ordering::Relaxed), 1);
    }
}
