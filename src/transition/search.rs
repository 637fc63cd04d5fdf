//! The search for the best match of each part: candidates, attempts and their scores.

pub(crate) mod attempts;
pub(crate) mod candidate;
pub(crate) mod group;
pub(crate) mod mirror_check;
