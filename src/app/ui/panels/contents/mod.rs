//! The options of what is seen.

pub mod colours;
pub mod field;
