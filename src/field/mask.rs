//! Binary images: the cells of a grid that are inside a design.
//!
//! A cell is inside if the winding number of the design around the cell's centre is not zero.
//! Guaranteed: a mask has at least one inside cell, and no side above [`Grid::MAX_SIDE`]. Not
//! guaranteed: parts thinner than a cell may fall between the cell centres and be lost.

use super::inside;
use super::{Grid, GridError, SampledFieldError};
use crate::geometry::{DVec2, Regions};

/// Binary image: says for each cell whether it is inside. Row 0 is the lowest row.
///
/// Cells beyond the border count as outside: a mask whose cells are all inside is valid and has its
/// boundary at the border.
///
/// ```
/// use morphospace::field::Mask;
///
/// let mask = Mask::new(3, 1, vec![false, true, true])?;
/// assert!(mask.bits()[1]);
/// assert!(Mask::new(3, 1, vec![false; 3]).is_err());
/// # Ok::<(), morphospace::field::MaskError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: u32,
    height: u32,
    bits: Vec<bool>,
}

/// Errors of creating a [`Mask`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaskError {
    /// The number of bits differs from the number of cells.
    #[error(transparent)]
    Length(#[from] SampledFieldError),
    /// No cell is inside.
    #[error("no grid cell is inside the design; use more cells or another threshold")]
    Empty,
    /// The grid is invalid, or the mask is larger than a grid may be.
    #[error(transparent)]
    Grid(#[from] GridError),
}

impl Mask {
    /// Creates a mask from `bits`: `height` rows of `width` cells, lowest row first; `true` is
    /// inside.
    ///
    /// # Errors
    /// Returns an error if a side is 0 or exceeds [`Grid::MAX_SIDE`], the number of bits differs
    /// from the number of cells, or no bit is set.
    pub fn new(width: u32, height: u32, bits: Vec<bool>) -> Result<Self, MaskError> {
        // The size limits are those of a grid; its position does not matter.
        Grid::new(width, height, DVec2::ZERO, 1.0)?;
        SampledFieldError::check(width, height, bits.len())?;
        if !bits.contains(&true) {
            return Err(MaskError::Empty);
        }
        Ok(Self {
            width,
            height,
            bits,
        })
    }

    /// Rasterises `regions`: a cell is inside if its centre is inside `regions`. The running time
    /// is proportional to the number of cells, plus the number of rows that each edge crosses.
    ///
    /// # Errors
    /// Returns an error if the grid is invalid, or no cell centre is inside.
    pub fn from_regions(regions: &Regions, grid: &Grid) -> Result<Self, MaskError> {
        grid.check()?;
        let bits = inside::inside_samples(&inside::lattice_edges(regions, grid), grid);
        Self::new(grid.width, grid.height, bits)
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Whether each cell is inside; cell (x, y) has index `y · width + x`.
    #[must_use]
    pub fn bits(&self) -> &[bool] {
        &self.bits
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{mask, text};
    use super::*;
    use crate::geometry::FillRule;

    fn regions(rings: &[&[(f64, f64)]]) -> Regions {
        let rings: Vec<Vec<DVec2>> = rings
            .iter()
            .map(|ring| ring.iter().map(|&p| p.into()).collect())
            .collect();
        Regions::from_rings(&rings, FillRule::EvenOdd).expect("an area")
    }

    #[test]
    fn a_frame_with_a_hole_is_rasterised_at_centres() {
        let frame = regions(&[
            &[(1.0, 1.0), (6.0, 1.0), (6.0, 5.0), (1.0, 5.0)],
            &[(2.4, 2.0), (2.4, 3.4), (4.6, 3.4), (4.6, 2.0)],
        ]);
        let grid = Grid::new(8, 6, DVec2::ZERO, 1.0).expect("a grid");
        let rasterised = Mask::from_regions(&frame, &grid).expect("cells inside");
        let expected = "
            ........
            .#####..
            .#####..
            .#...#..
            .#####..
            ........";
        assert_eq!(text(&rasterised), text(&mask(expected)));
    }

    #[test]
    fn it_agrees_with_the_winding_number_of_each_centre() {
        let star: Vec<(f64, f64)> = (0..11)
            .map(|i| {
                let angle = f64::from(i * 4) * std::f64::consts::TAU / 11.0;
                (3.0 * angle.cos() + 0.1, 3.0 * angle.sin() - 0.2)
            })
            .collect();
        let star = regions(&[&star]);
        let grid = Grid::new(70, 50, DVec2::new(-2.0, -3.1), 0.11).expect("a grid");
        let mask = Mask::from_regions(&star, &grid).expect("cells inside");
        for y in 0..grid.height {
            for x in 0..grid.width {
                let bit = mask.bits()[(y * grid.width + x) as usize];
                assert_eq!(bit, star.contains(grid.centre(x, y)), "cell ({x}, {y})");
            }
        }
    }

    #[test]
    fn a_design_beyond_the_frame_fills_the_mask() {
        let big = regions(&[&[(-9.0, -9.0), (19.0, -9.0), (19.0, 19.0), (-9.0, 19.0)]]);
        let grid = Grid::new(4, 3, DVec2::ZERO, 1.0).expect("a grid");
        let mask = Mask::from_regions(&big, &grid).expect("cells inside");
        assert!(mask.bits().iter().all(|&b| b));
    }

    #[test]
    fn an_empty_mask_and_wrong_sizes_are_refused() {
        assert_eq!(Mask::new(2, 2, vec![false; 4]), Err(MaskError::Empty));
        assert!(matches!(
            Mask::new(2, 2, vec![true; 3]),
            Err(MaskError::Length(SampledFieldError { values: 3, .. }))
        ));
        for (width, height) in [
            (0, 1),
            (1, 0),
            (Grid::MAX_SIDE + 1, 1),
            (u32::MAX, u32::MAX),
        ] {
            let refused = Mask::new(width, height, Vec::new());
            assert_eq!(refused, Err(GridError::Size { width, height }.into()));
        }
        let dust = regions(&[&[(0.1, 0.1), (0.2, 0.1), (0.2, 0.2)]]);
        let grid = Grid::new(4, 4, DVec2::ZERO, 1.0).expect("a grid");
        assert_eq!(Mask::from_regions(&dust, &grid), Err(MaskError::Empty));
    }
}
