//! What is kept for the next start: changes that were not saved, how films are made, and what was
//! opened last.

pub mod autosave;
pub mod presets;
pub mod recent;
pub mod slot;
