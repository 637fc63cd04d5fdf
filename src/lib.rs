//! Morphospace: the space of all forms between given forms.

pub mod cli;
pub mod compatible;
pub mod content;
pub mod design;
pub mod export;
pub mod field;
pub mod geometry;
pub mod homotopy;
pub mod linalg;
pub mod measure;
pub mod mesh;
pub mod progress;
pub mod project;
pub mod transition;
pub mod warp;
#[cfg(feature = "bevy")]
pub mod stage;
