//! What is kept for the next start: changes that were not saved, how films are made, what was
//! opened last, and the strips of the gallery.

pub mod autosave;
pub mod autosave_slot;
pub mod film_presets;
pub mod gallery_strips;
pub mod recent_files;
