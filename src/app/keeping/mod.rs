//! What is kept for the next start: changes that were not saved, how films are made, what was
//! opened last, and the strips of the gallery.

pub mod autosave;
pub mod presets;
pub mod recent;
pub mod slot;
pub mod strips;
