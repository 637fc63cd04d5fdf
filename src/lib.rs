//! Morphospace: the space of all forms between given forms.

pub mod geometry;
pub mod linalg;
pub mod mesh;
pub mod progress;
