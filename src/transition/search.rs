//! The search for the best match of each piece. Several candidate matches are rated by their
//! motion.
//!
//! - `candidate`: a candidate match of a piece, with its mesh and the defects of its motion
//! - `group`: matches the pieces of a group, that is, of parts that are matched together, with
//!   several match options
//! - `attempts`: the table of attempts, which try other match options for certain pieces
//! - `sliding`: slides corresponding points of the best matches along the outlines, and chooses the
//!   better of two results
//! - `mirror_check`: checks whether the designs would match better if one were mirrored

pub(crate) mod attempts;
pub(crate) mod candidate;
pub(crate) mod group;
pub(crate) mod mirror_check;
mod sliding;
