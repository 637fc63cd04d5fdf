//! Bisection of a time interval by the two proofs: that no face folds, and that no outlines meet.
//!
//! Guaranteed: a bisection ends. Both the depth and the number of parts are bounded; parts that are
//! undecided then count as not proved. Threads share the earliest failure, so that no thread
//! examines later times.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

/// Maximum number of times that an interval is halved to prove that a face does not fold or that a
/// vertex stays off an edge (tolerance: the last part is 2⁻³⁰ of the interval, about 1e-9).
pub(super) const MAX_HALVINGS: u32 = 30;

/// Maximum number of parts of an interval that are examined for one face, or for one vertex and
/// edge (resource limit: where rounding errors are as large as the distances, up to 2³⁰ parts would
/// be examined).
const MAX_PARTS: u32 = 4096;

/// Earliest time at which any thread has failed to prove that a face does not fold, or that a
/// vertex stays off an edge, as the fraction s of the interval. No thread needs to examine later
/// times.
pub(super) struct EarliestFailure(AtomicU64);

impl Default for EarliestFailure {
    fn default() -> Self {
        Self(AtomicU64::new(f64::INFINITY.to_bits()))
    }
}

impl EarliestFailure {
    /// Returns whether a proof has already failed at a time before `s`.
    pub(super) fn is_before(&self, s: f64) -> bool {
        // Relaxed ordering suffices, because the number only saves work. The bits of non-negative
        // floats are ordered like the floats.
        self.0.load(Ordering::Relaxed) < s.to_bits()
    }

    /// Records that a proof has failed at `s`, and returns `s`.
    pub(super) fn report(&self, s: f64) -> f64 {
        self.0.fetch_min(s.to_bits(), Ordering::Relaxed);
        s
    }
}

/// Bisection of an interval for one face, or for one vertex and edge.
pub(super) struct Bisection<'e> {
    /// Shared by the bisections of all faces, or of all vertices and edges.
    pub(super) earliest: &'e EarliestFailure,
    parts_left: Cell<u32>,
}

impl<'e> Bisection<'e> {
    pub(super) fn new(earliest: &'e EarliestFailure) -> Self {
        Self {
            earliest,
            parts_left: Cell::new(MAX_PARTS),
        }
    }

    /// Uses up one part; returns whether there was one left.
    pub(super) fn try_use_part(&self) -> bool {
        let left = self.parts_left.get();
        self.parts_left.set(left.saturating_sub(1));
        left > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_earliest_failure_is_kept() {
        let earliest = EarliestFailure::default();
        assert!(!earliest.is_before(1.0));
        for s in [0.5, 0.25, 0.75] {
            assert_eq!(earliest.report(s), s);
        }
        assert!(earliest.is_before(0.5) && !earliest.is_before(0.25));
    }

    #[test]
    fn a_bisection_ends_after_its_parts() {
        let earliest = EarliestFailure::default();
        let search = Bisection::new(&earliest);
        let parts = (1..).take_while(|_| search.try_use_part()).count();
        assert_eq!(parts, MAX_PARTS as usize);
        assert!(!search.try_use_part(), "the end is final");
        let other = Bisection::new(&earliest);
        assert!(other.try_use_part(), "each face has its own parts");
    }
}
