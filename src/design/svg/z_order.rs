//! A coarse grid over the page that stores the height of the topmost layer in each cell.

use crate::geometry::{Bounds, DVec2};

/// Number of cells along each side of the page (resource limit: 200,000 shapes as large as the
/// page take one second; more cells would separate more shapes).
const CELLS: usize = 64;

/// Height of the topmost layer in each cell of a page: one plus the index of that layer, or 0 where
/// nothing is painted.
pub(super) struct ZOrderGrid {
    /// Width and height of the page.
    page: DVec2,
    /// Height of each cell, row by row from the bottom.
    cells: Vec<usize>,
}

impl ZOrderGrid {
    /// Creates an empty grid for a page of the given size.
    pub(super) fn of_page(page: DVec2) -> Self {
        Self {
            page,
            cells: vec![0; CELLS * CELLS],
        }
    }

    /// Returns the maximum height of the cells that a box touches.
    pub(super) fn highest(&self, bounds: &Bounds) -> usize {
        let heights = self.covered_cells(bounds).map(|cell| self.cells[cell]);
        heights.max().unwrap_or(0)
    }

    /// Raises the height of all cells that a box touches to at least `to`.
    pub(super) fn raise(&mut self, bounds: &Bounds, to: usize) {
        for cell in self.covered_cells(bounds) {
            self.cells[cell] = self.cells[cell].max(to);
        }
    }

    /// Returns the indices of the cells that a box touches. Positions outside of the page belong to
    /// the nearest cell at its border.
    fn covered_cells(&self, bounds: &Bounds) -> impl Iterator<Item = usize> + use<> {
        let cell = |p: DVec2| {
            let along = p / self.page * CELLS as f64;
            // The cast turns negative numbers and NaN into 0.
            along.to_array().map(|x| (x as usize).min(CELLS - 1))
        };
        let [[left, low], [right, high]] = [cell(bounds.min), cell(bounds.max)];
        (low..=high).flat_map(move |y| (left..=right).map(move |x| y * CELLS + x))
    }
}
