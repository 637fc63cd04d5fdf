//! Pictures and films, and where they go.

pub mod files;
pub mod films;
pub mod pictures;
