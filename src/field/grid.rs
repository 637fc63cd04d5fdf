//! The grid that a field is measured on.
//!
//! Distances are counted in its cells, so that a grid is part of what a blend
//! means; a project stores it. Row 0 is the lowest, and a sample is at the
//! centre of its cell. Guarantees: a grid that passed [`Grid::check`] is
//! finite, and small enough for a texture and for exact squares.

use crate::geometry::{Bounds, DVec2};

/// Square cells over a rectangle of the plane.
///
/// The *lattice* of a grid has its unit in the cell and its origin at the
/// centre of cell (0, 0), so that samples have integer coordinates.
///
/// ```
/// use morphospace::field::Grid;
/// use morphospace::geometry::{Bounds, DVec2};
///
/// let design = Bounds { min: DVec2::ZERO, max: DVec2::new(80.0, 30.0) };
/// let grid = Grid::covering(&design, 100, 0.125)?;
/// assert_eq!((grid.width, grid.height, grid.cell), (100, 50, 1.0));
/// assert_eq!(grid.centre(0, 0), DVec2::new(-9.5, -9.5));
/// # Ok::<(), morphospace::field::GridError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Cells along a row, 1 to [`Grid::MAX_SIDE`].
    pub width: u32,
    /// Rows, 1 to [`Grid::MAX_SIDE`].
    pub height: u32,
    /// The lower left corner of cell (0, 0).
    pub origin: DVec2,
    /// The side of a cell, positive.
    pub cell: f64,
}

/// Why there is no such grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// A side is 0 or above the limit.
    #[error(
        "a grid of {width} × {height} cells: choose 1 to {} cells for each side",
        Grid::MAX_SIDE
    )]
    Size {
        /// Cells along a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The origin or the cell is not finite, or the cell is not positive.
    #[error(
        "a grid at ({}, {}) with cells of {cell}: both must be finite and the cell above 0",
        origin.x,
        origin.y
    )]
    Place {
        /// Lower left corner.
        origin: DVec2,
        /// Side of a cell.
        cell: f64,
    },
    /// The rectangle to cover has no extent or is not finite.
    #[error("there is no grid over a rectangle of {} × {}: check the size of the design", size.x, size.y)]
    Bounds {
        /// Size of the rectangle.
        size: DVec2,
    },
    /// The margin is negative or above [`Grid::MAX_MARGIN`].
    #[error("the margin is {0}: choose 0 to {max} of the longer side", max = Grid::MAX_MARGIN)]
    Margin(f64),
}

impl Grid {
    /// Cells along a side at most: what every desktop GPU takes as a texture,
    /// and what keeps every squared distance exact in 32 bits.
    pub const MAX_SIDE: u32 = 8192;

    /// Margin at most, in longer sides: with it a design has a ninth of its
    /// grid's side. More is a slip.
    pub const MAX_MARGIN: f64 = 4.0;

    /// A share of a cell that rounding may cost where cells are counted: a
    /// square of 0.1 by 10 cells is not to get 11 rows.
    const COUNT_SLACK: f64 = 1e-9;

    /// A grid of `width` × `height` cells with sides `cell`, its lower left
    /// corner at `origin`.
    ///
    /// # Errors
    /// Where a side is 0 or above [`Self::MAX_SIDE`], or a number is not finite
    /// or the cell not positive.
    pub fn new(width: u32, height: u32, origin: DVec2, cell: f64) -> Result<Self, GridError> {
        let grid = Self {
            width,
            height,
            origin,
            cell,
        };
        grid.check()?;
        Ok(grid)
    }

    /// A grid with `cells` along the longer side of `bounds` after it was
    /// widened on all sides by `margin`, a fraction of its longer side. It has
    /// the same centre; the shorter side is rounded up to whole cells.
    ///
    /// # Errors
    /// Where the rectangle has no extent, the margin is out of range, or there
    /// would be too many or no cells.
    pub fn covering(bounds: &Bounds, cells: u32, margin: f64) -> Result<Self, GridError> {
        let size = bounds.max - bounds.min;
        let longer = size.max_element();
        if !(size.is_finite() && size.min_element() >= 0.0 && longer > 0.0) {
            return Err(GridError::Bounds { size });
        }
        if !(0.0..=Self::MAX_MARGIN).contains(&margin) {
            return Err(GridError::Margin(margin));
        }
        // The same width all around, by the longer side: flat designs have room
        // above, too.
        let padded = size + DVec2::splat(2.0 * margin * longer);
        let cell = padded.max_element() / f64::from(cells);
        let count = |side: f64| (side / cell - Self::COUNT_SLACK).ceil().max(1.0) as u32;
        // The longer side is to have `cells`, which rounding could exceed by
        // one.
        let (width, height) = (count(padded.x).min(cells), count(padded.y).min(cells));
        let half = 0.5 * cell * DVec2::new(f64::from(width), f64::from(height));
        let centre = bounds.min + 0.5 * size;
        Self::new(width, height, centre - half, cell)
    }

    /// That the fields hold what is said about them: they are public.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn check(&self) -> Result<(), GridError> {
        let sides = 1..=Self::MAX_SIDE;
        if !sides.contains(&self.width) || !sides.contains(&self.height) {
            return Err(GridError::Size {
                width: self.width,
                height: self.height,
            });
        }
        if !(self.origin.is_finite() && self.cell.is_finite() && self.cell > 0.0) {
            return Err(GridError::Place {
                origin: self.origin,
                cell: self.cell,
            });
        }
        Ok(())
    }

    /// How many cells there are.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The centre of the cell in column `x` and row `y`.
    #[must_use]
    pub fn centre(&self, x: u32, y: u32) -> DVec2 {
        self.plane_from_lattice(DVec2::new(f64::from(x), f64::from(y)))
    }

    /// The rectangle that the cells cover.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let size = self.cell * DVec2::new(f64::from(self.width), f64::from(self.height));
        Bounds {
            min: self.origin,
            max: self.origin + size,
        }
    }

    /// Where a point of the plane is on the lattice of samples.
    #[must_use]
    pub fn lattice_from_plane(&self, p: DVec2) -> DVec2 {
        (p - self.origin) / self.cell - DVec2::splat(0.5)
    }

    /// Where a point of the lattice of samples is in the plane.
    #[must_use]
    pub fn plane_from_lattice(&self, p: DVec2) -> DVec2 {
        self.origin + (p + DVec2::splat(0.5)) * self.cell
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(width: f64, height: f64) -> Bounds {
        Bounds {
            min: DVec2::new(3.0, -2.0),
            max: DVec2::new(3.0 + width, height - 2.0),
        }
    }

    #[test]
    fn it_covers_the_rectangle_and_its_margin_around_one_centre() {
        for (width, height, margin) in [(7.0, 3.0, 0.1), (0.1, 0.1, 0.0), (1.0, 9.0, 0.5)] {
            let bounds = rectangle(width, height);
            let grid = Grid::covering(&bounds, 50, margin).expect("a legal grid");
            let covered = grid.bounds();
            let longer = f64::max(width, height);
            let slack = 1e-6 * longer;
            let wanted = bounds.size() + DVec2::splat(2.0 * margin * longer - slack);
            assert!(covered.size().cmpge(wanted).all());
            assert!(covered.size().cmple(wanted + grid.cell + 2.0 * slack).all());
            assert!(covered.centre().distance(bounds.centre()) < 1e-12);
            assert_eq!(grid.width.max(grid.height), 50);
        }
    }

    #[test]
    fn a_square_has_as_many_rows_as_columns() {
        let grid = Grid::covering(&rectangle(0.1, 0.1), 10, 0.1).expect("a legal grid");
        assert_eq!((grid.width, grid.height), (10, 10));
    }

    #[test]
    fn plane_and_lattice_are_inverse() {
        let grid = Grid::new(4, 5, DVec2::new(-1.5, 2.0), 0.25).expect("a legal grid");
        let p = DVec2::new(0.3, 2.7);
        let back = grid.plane_from_lattice(grid.lattice_from_plane(p));
        assert!(back.distance(p) < 1e-14);
        let centre = grid.lattice_from_plane(grid.centre(3, 2));
        assert_eq!(centre, DVec2::new(3.0, 2.0));
    }

    #[test]
    fn hostile_sizes_are_refused() {
        let unit = rectangle(1.0, 1.0);
        assert!(matches!(
            Grid::covering(&unit, 0, 0.0),
            Err(GridError::Size { .. } | GridError::Place { .. })
        ));
        let too_many = Grid::MAX_SIDE + 1;
        assert_eq!(
            Grid::covering(&unit, too_many, 0.0),
            Err(GridError::Size {
                width: too_many,
                height: too_many
            })
        );
        assert!(Grid::covering(&unit, u32::MAX, 0.0).is_err());
        assert!(Grid::covering(&rectangle(0.0, 0.0), 9, 0.0).is_err());
        assert!(Grid::covering(&rectangle(f64::NAN, 1.0), 9, 0.0).is_err());
        assert!(Grid::covering(&rectangle(f64::INFINITY, 1.0), 9, 0.0).is_err());
        for margin in [-0.1, f64::NAN, 1e9] {
            assert!(matches!(
                Grid::covering(&unit, 9, margin),
                Err(GridError::Margin(_))
            ));
        }
        for cell in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Grid::new(2, 2, DVec2::ZERO, cell).is_err());
        }
        assert!(Grid::new(2, 2, DVec2::NAN, 1.0).is_err());
    }
}
