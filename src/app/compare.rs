//! Comparison: shows the transition of a second method next to the stage, at the same t.

pub mod comparison;
