//! Analysis in the background: measures of the film, search for the best method, suggestions.

pub mod film_measures;
pub mod method_search;
pub mod stage_recording;
pub mod suggestions;
pub mod transition_memo;
