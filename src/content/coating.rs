//! How the parts of a solid are painted, over and under each other.

use crate::colour::{Line, Paint};

/// The coats that the rings of a solid are in.
#[derive(Clone, Debug, PartialEq)]
pub struct Coating {
    /// What there is of paint.
    pub coats: Vec<Coat>,
    /// For each boundary walk its coat.
    pub of_walks: Vec<usize>,
    /// For each hole its coat.
    pub of_holes: Vec<usize>,
    /// The t at which those change places that lie over each other otherwise in
    /// the target than in the source.
    pub reordered_at: f64,
}

/// Parts that are painted alike, in both designs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// In source and target; none where the design has no colour of its own.
    pub paints: [Option<Paint>; 2],
    /// The line along their outlines in source and target, where there is one.
    pub lines: [Option<Line>; 2],
    /// How many coats lie below, in source and target.
    pub heights: [usize; 2],
}

impl Coating {
    /// The coats as they lie at `t`, the lowest first.
    #[must_use]
    pub fn order(&self, t: f64) -> Vec<usize> {
        let end = usize::from(t >= self.reordered_at);
        let mut order: Vec<usize> = (0..self.coats.len()).collect();
        order.sort_by_key(|&coat| self.coats[coat].heights[end]);
        order
    }
}
