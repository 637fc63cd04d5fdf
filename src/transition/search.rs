//! The search for the best match of each piece: candidates, attempts and their ratings.
//!
//! - `candidate`: a matched piece, its mesh and the defects of its motion
//! - `group`: matches the pieces of a group of parts with several match options
//! - `attempts`: the table of attempts, which try other match options for certain pieces
//! - `sliding`: slides the boundary correspondence of the best candidates, and chooses the better
//!   of two results
//! - `mirror_check`: checks whether the designs would match better if one were mirrored

pub(crate) mod attempts;
pub(crate) mod candidate;
pub(crate) mod group;
pub(crate) mod mirror_check;
mod sliding;
