//! What is kept for the next start: changes that were not saved, and how films are
//! made.

pub mod autosave;
pub mod presets;
pub mod slot;
