//! Background analysis of the transition on the stage: its recording, measures and defects, the
//! search for the best method, suggested changes, and a cache of these results.

pub mod film_measures;
pub mod method_search;
pub mod stage_recording;
pub mod suggestions;
pub mod transition_memo;

use crate::transition::Transition;

/// Whether results computed for the transition `cached` are valid for the transition on the stage,
/// `staged`.
fn is_same(cached: Option<&Transition>, staged: Option<&Transition>) -> bool {
    match (cached, staged) {
        (Some(cached), Some(staged)) => cached.is_same(staged),
        (None, None) => true,
        _ => false,
    }
}
