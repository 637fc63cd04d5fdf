//! Cache of results computed for transitions that may return to the stage.

use crate::transition::{Transition, TransitionId};

/// Results, each with the id of its transition. The entry of a dropped transition is removed on the
/// next insertion, so the cache does not grow with projects that were closed.
#[derive(Debug)]
pub struct TransitionMemo<T>(Vec<(TransitionId, T)>);

impl<T> Default for TransitionMemo<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> TransitionMemo<T> {
    /// Stores a result for a transition, and removes the results of dropped transitions.
    pub fn insert(&mut self, of: &Transition, result: T) {
        self.0.retain(|(id, _)| !id.is_dropped());
        self.0.push((of.id(), result));
    }

    /// Removes and returns the result for a transition.
    pub fn take(&mut self, of: &Transition) -> Option<T> {
        let index = self.0.iter().position(|(id, _)| id.is_of(of))?;
        Some(self.0.swap_remove(index).1)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::design::{ImportOptions, import};
    use crate::transition::TransitionSpec;
    use crate::work::progress::Silent;

    fn transition() -> Transition {
        let design = || {
            let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
            Arc::new(import("a", triangle, &ImportOptions::default()).expect("a triangle"))
        };
        let spec = TransitionSpec::new(design(), design());
        Transition::build(&spec, &Silent).expect("two triangles")
    }

    #[test]
    fn a_result_is_returned_once() {
        let [one, other] = [transition(), transition()];
        let mut memo = TransitionMemo::default();
        memo.insert(&one, 1);
        assert_eq!(memo.take(&other), None);
        assert_eq!(memo.take(&one.clone()), Some(1));
        assert_eq!(memo.take(&one), None);
    }

    #[test]
    fn the_cache_keeps_no_transition_alive() {
        let mut memo = TransitionMemo::default();
        for _ in 0..3 {
            memo.insert(&transition(), ());
        }
        // The last entry's transition was dropped after the entry was stored, so only the next
        // insertion would remove the entry.
        assert_eq!(memo.0.len(), 1);
        assert!(memo.0[0].0.is_dropped());
    }
}
