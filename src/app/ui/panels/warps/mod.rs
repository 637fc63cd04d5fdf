//! The options of how it moves.

pub mod lattice;
pub mod lines;
pub mod paths;
pub mod rigid;
pub mod scattered;
pub mod travel;
