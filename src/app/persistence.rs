//! Files that persist between starts of the application: autosaves, export presets, recent files
//! and cached gallery strips.

pub mod autosave;
pub mod autosave_slot;
pub mod film_presets;
pub mod gallery_strips;
pub mod recent_files;
