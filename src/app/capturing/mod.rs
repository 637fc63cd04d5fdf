//! Pictures and films, and where they go.

pub mod blends;
pub mod copying;
pub mod estimate;
pub mod files;
pub mod films;
pub mod framing;
pub mod kept;
pub mod order;
pub mod pictures;
