//! The search for the best match of each piece: candidates, attempts and their ratings.
//!
//! - `candidate`: a matched piece and the defects of its motion
//! - `group`: variants of matching the pieces of a group of parts
//! - `attempts`: the table of attempts, each for some pieces and with some variants
//! - `sliding`: slides the boundary correspondence of the best candidates, and chooses between them
//! - `mirror_check`: whether the designs would match better if one were mirrored

pub(crate) mod attempts;
pub(crate) mod candidate;
pub(crate) mod group;
pub(crate) mod mirror_check;
mod sliding;
