//! Grid of a distance field: square cells over a rectangle of the plane.
//!
//! Distances are in cells, so the result of a blend depends on the grid; a project therefore stores
//! its grid. Row 0 is the lowest row, and samples lie at cell centres. Guaranteed: a grid that
//! passed [`Grid::check`] is finite, small enough for a GPU texture, and small enough for squared
//! distances to be exact 32-bit integers.

use crate::geometry::{Bounds, DVec2};

/// Square cells over a rectangle of the plane.
///
/// The grid's *lattice* coordinates have the cell as unit and the centre of cell (0, 0) as origin,
/// so samples have integer coordinates.
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
    /// Number of columns, 1 to [`Grid::MAX_SIDE`].
    pub width: u32,
    /// Number of rows, 1 to [`Grid::MAX_SIDE`].
    pub height: u32,
    /// Lower left corner of cell (0, 0), in the plane.
    pub origin: DVec2,
    /// Side length of a cell in units of the plane, positive.
    pub cell: f64,
}

/// Errors of creating or checking a [`Grid`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// A side is 0 or exceeds [`Grid::MAX_SIDE`].
    #[error(
        "the grid has {width} × {height} cells; choose 1 to {} cells per side",
        Grid::MAX_SIDE
    )]
    Size {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
    },
    /// The origin or the cell size is not finite, or the cell size is not positive.
    #[error(
        "the grid has its origin at ({}, {}) and cell size {cell}; both must be finite and the cell size above 0",
        origin.x,
        origin.y
    )]
    Place {
        /// Lower left corner of the grid, in the plane.
        origin: DVec2,
        /// Side length of a cell.
        cell: f64,
    },
    /// The rectangle to cover has no extent or is not finite.
    #[error("a grid cannot cover a rectangle of {} × {}; check the size of the design", size.x, size.y)]
    Bounds {
        /// Width and height of the rectangle.
        size: DVec2,
    },
    /// The margin is negative or exceeds [`Grid::MAX_MARGIN`].
    #[error("the margin is {0}; choose a fraction of the longer side from 0 to {max}", max = Grid::MAX_MARGIN)]
    Margin(f64),
}

impl Grid {
    /// Maximum number of cells per side (resource limit: every desktop GPU accepts textures of this
    /// size, and squared distances stay exact in 32 bits).
    pub const MAX_SIDE: u32 = 8192;

    /// Maximum margin on each side of a design, as a multiple of its longer side (resource limit:
    /// the design then covers only a ninth of the grid's longer side).
    pub const MAX_MARGIN: f64 = 4.0;

    /// Amount by which a computed number of rows or columns may exceed an integer without being
    /// rounded up, in cells (tolerance: rounding errors must not turn 10 rows into 11).
    const COUNT_SLACK: f64 = 1e-9;

    /// Creates a grid of `width` × `height` cells with side length `cell` and its lower left corner
    /// at `origin`.
    ///
    /// # Errors
    /// Returns an error if a side is 0 or exceeds [`Self::MAX_SIDE`], a number is not finite, or
    /// the cell size is not positive.
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

    /// Creates a grid around `bounds` widened by a margin.
    ///
    /// The margin on all sides is `margin` times the longer side of `bounds`. The longer side of
    /// the grid has `cells` cells; the shorter one is rounded up to whole cells. The centre stays
    /// the same.
    ///
    /// # Errors
    /// Returns an error if the rectangle has no extent, the margin is out of range, or the number
    /// of cells is 0 or too large.
    pub fn covering(bounds: &Bounds, cells: u32, margin: f64) -> Result<Self, GridError> {
        let size = bounds.max - bounds.min;
        let longer = size.max_element();
        if !(size.is_finite() && size.min_element() >= 0.0 && longer > 0.0) {
            return Err(GridError::Bounds { size });
        }
        if !(0.0..=Self::MAX_MARGIN).contains(&margin) {
            return Err(GridError::Margin(margin));
        }
        // The margin is the same on all sides, so flat designs have space above and below, too.
        let padded = size + DVec2::splat(2.0 * margin * longer);
        let cell = padded.max_element() / f64::from(cells);
        let count = |side: f64| (side / cell - Self::COUNT_SLACK).ceil().max(1.0) as u32;
        // Rounding errors could give the longer side one cell more than `cells`.
        let (width, height) = (count(padded.x).min(cells), count(padded.y).min(cells));
        let half = 0.5 * cell * DVec2::new(f64::from(width), f64::from(height));
        let centre = bounds.min + 0.5 * size;
        Self::new(width, height, centre - half, cell)
    }

    /// Checks the public fields against their documented ranges.
    ///
    /// # Errors
    /// Same as [`Self::new`].
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

    /// Number of cells: `width` · `height`.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Centre of the cell in column `x` and row `y`, in the plane.
    #[must_use]
    pub fn centre(&self, x: u32, y: u32) -> DVec2 {
        self.plane_from_lattice(DVec2::new(f64::from(x), f64::from(y)))
    }

    /// Rectangle that the cells cover, in the plane.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let size = self.cell * DVec2::new(f64::from(self.width), f64::from(self.height));
        Bounds {
            min: self.origin,
            max: self.origin + size,
        }
    }

    /// Converts a point of the plane to lattice coordinates.
    #[must_use]
    pub fn lattice_from_plane(&self, p: DVec2) -> DVec2 {
        (p - self.origin) / self.cell - DVec2::splat(0.5)
    }

    /// Converts lattice coordinates to a point of the plane.
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
            let min_size = bounds.size() + DVec2::splat(2.0 * margin * longer - slack);
            assert!(covered.size().cmpge(min_size).all());
            assert!(
                covered
                    .size()
                    .cmple(min_size + grid.cell + 2.0 * slack)
                    .all()
            );
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
