//! Project files (`.morph`): designs, method, options, timing, stops and style, and the gallery.
//!
//! The format is TOML with a version number; paths are relative to the file. Unknown keys and newer
//! versions are errors that name the line. Writing is atomic, so an interrupted write leaves the
//! old file. Reading a written project gives an equal one; only comments are lost.

mod document;
mod error;
pub mod gallery;
mod loaded;
mod map;
mod segment_features;
mod segment_settings;
mod segments;
mod serialization;
pub(crate) mod title;

#[cfg(test)]
mod tests;

pub use document::{DesignEntry, FORMAT_VERSION, Project};
pub use error::ProjectError;
pub use loaded::LoadedProject;
pub use map::{MAX_PLACES, MapError, MapSettings, SavedBlend};
pub use segment_settings::SegmentRecord;
pub use segments::MovedDesigns;
