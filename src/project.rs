//! The `.morph` document: designs, method, options, timing, stops and style.
//!
//! TOML with a version. Paths are relative to the document. Reading refuses
//! unknown keys and newer versions and names the line; writing is atomic, so
//! that an interrupted write leaves the old document. What is written is read
//! back equal, except for comments, which are not kept.

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
pub use map::{MOST_PLACES, MapError, MapSettings, SavedPlace};
pub use segment_settings::SegmentRecord;
pub use segments::MovedDesigns;
