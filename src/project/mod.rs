//! The `.morph` document: designs, method, options, timing, stops and style.
//!
//! TOML with a version. Paths are relative to the document. Reading refuses
//! unknown keys and newer versions and names the line; writing is atomic, so
//! that an interrupted write leaves the old document. What is written is read
//! back equal, except for comments, which are not kept.

mod document;
mod error;
mod features;
pub mod gallery;
mod leg;
mod legs;
mod load;
mod map;
mod reading;
pub(crate) mod title;

#[cfg(test)]
mod tests;

pub use document::{DesignEntry, FORMAT_VERSION, Project};
pub use error::ProjectError;
pub use leg::Leg;
pub use legs::Moved;
pub use load::LoadedProject;
pub use map::{KeptPlace, MOST_PLACES, MapError, MapSettings};
