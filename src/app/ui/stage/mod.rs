//! What lies on the stage: the hand on it, the second method beside it, the verdict.

pub mod area;
pub mod film;
pub mod twin;
pub mod verdict;
