//! A film in words: what goes wrong, where, why, and what helps.
//!
//! Every cause is a measured fact about the place where the trouble is worst:
//! an angle, a stretch of the boundary, an overlap. A remedy that changes an
//! option was tried on the same designs at the same t, and says what it
//! leaves; pins and edits, which cannot be tried, are named with their place.
//! Guaranteed: what is said was seen at one of the steps. Not guaranteed:
//! anything between two steps, or that a cause is the only one.
//!
//! - `judge`: from a film to a verdict
//! - `scan`: at each t, how much is wrong
//! - `scene`: rigid parts at the t of a trouble; `cause`: the facts about it
//! - `solid`, `field`, `plane`: what is found in rigid parts and boundaries, in
//!   fields, and with warps of the plane
//! - `remedy`: what was tried
//! - `finding`, `words`: what can be found, and how it is said

mod cause;
mod field;
mod finding;
mod judge;
mod plane;
mod remedy;
mod scan;
mod scene;
mod solid;
#[cfg(test)]
mod tests;
mod words;

pub use finding::{Cause, Change, Finding, Remedy, Trouble};
pub use judge::Verdict;
