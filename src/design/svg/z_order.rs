//! How high a page is painted, cell by cell.

use crate::geometry::{Bounds, DVec2};

/// Cells of the page along each side. More would tell more shapes apart, and
/// cost more for large ones: 200,000 shapes as large as the page take a second.
const CELLS: usize = 64;

/// For each cell of a page how high it is painted, 0 where it is not.
pub(super) struct ZOrderGrid {
    page: DVec2,
    cells: Vec<usize>,
}

impl ZOrderGrid {
    pub(super) fn of_page(page: DVec2) -> Self {
        Self {
            page,
            cells: vec![0; CELLS * CELLS],
        }
    }

    /// The highest that a box may lie on.
    pub(super) fn highest(&self, bounds: &Bounds) -> usize {
        let heights = self.covered(bounds).map(|cell| self.cells[cell]);
        heights.max().unwrap_or(0)
    }

    /// Nothing in a box is lower than this any more.
    pub(super) fn raise(&mut self, bounds: &Bounds, to: usize) {
        for cell in self.covered(bounds) {
            self.cells[cell] = self.cells[cell].max(to);
        }
    }

    /// The cells that a box covers; beyond the page those at its edge.
    fn covered(&self, bounds: &Bounds) -> impl Iterator<Item = usize> + use<> {
        let cell = |p: DVec2| {
            let along = p / self.page * CELLS as f64;
            // What is negative or no number is 0.
            along.to_array().map(|x| (x as usize).min(CELLS - 1))
        };
        let [[left, low], [right, high]] = [cell(bounds.min), cell(bounds.max)];
        (low..=high).flat_map(move |y| (left..=right).map(move |x| y * CELLS + x))
    }
}
