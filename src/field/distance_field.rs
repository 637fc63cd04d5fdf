//! Signed distance fields of designs.
//!
//! Guarantees: positive inside and negative outside, in cells of the grid;
//! from polygons exact up to rounding, from masks equal to brute force.
//! Between samples a field is bilinear, as the stage's shader has it. Does not
//! guarantee: between samples it is no distance, and near the medial axis it
//! is rounded off by up to half a cell.

use super::{
    Grid, GridError, Mask, MaskError, Metric, SampledField, SampledFieldError, distance_transform,
};
use super::{inside, polygon_distance};
use crate::geometry::{DVec2, Regions};
use crate::work::progress::{Cancelled, Progress};

/// A signed distance for each sample of a grid.
///
/// ```
/// use morphospace::field::{DistanceField, Grid};
/// use morphospace::geometry::{DVec2, FillRule, Regions};
/// use morphospace::work::progress::Silent;
///
/// let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let square = Regions::from_rings(&[square.to_vec()], FillRule::NonZero)?;
/// let grid = Grid::covering(&square.bounds(), 64, 0.5)?; // 8 cells a unit
/// let field = DistanceField::from_regions(&square, grid, &Silent)?;
/// assert!((field.value(DVec2::new(2.0, 1.0)) - 8.0).abs() < 1e-5);
/// assert!((field.value(DVec2::new(-1.0, 2.0)) + 8.0).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    grid: Grid,
    values: Vec<f32>,
}

/// Why there is no such field.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The grid is none.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The mask is none.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// There are not as many values as cells.
    #[error(transparent)]
    Length(#[from] SampledFieldError),
    /// A value is NaN or infinite.
    #[error("the distance at cell ({x}, {y}) is not a finite number; measure the field again")]
    NotFinite {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
    },
    /// Nobody wants the field any more.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl DistanceField {
    /// A field of known values, row-major, the lowest row first.
    ///
    /// # Errors
    /// Where the grid is none, there are not as many values as cells, or one
    /// is not finite.
    pub fn new(grid: Grid, values: Vec<f32>) -> Result<Self, FieldError> {
        grid.check()?;
        let Grid { width, height, .. } = grid;
        SampledFieldError::check(width, height, values.len())?;
        if let Some(bad) = values.iter().position(|v| !v.is_finite()) {
            let (x, y) = (bad as u32 % width, bad as u32 / width);
            return Err(FieldError::NotFinite { x, y });
        }
        Ok(Self { grid, values })
    }

    /// One value all over a grid that was checked.
    pub(crate) fn even(grid: Grid, value: f64) -> Self {
        let value = value.clamp(f32::MIN.into(), f32::MAX.into()) as f32;
        Self {
            values: vec![value; grid.width as usize * grid.height as usize],
            grid,
        }
    }

    /// The distance transform of a mask that has the grid's size.
    ///
    /// # Errors
    /// Where the grid is none, the mask has another size, or the work was
    /// cancelled.
    pub fn from_mask(
        mask: &Mask,
        grid: Grid,
        metric: Metric,
        progress: &dyn Progress,
    ) -> Result<Self, FieldError> {
        grid.check()?;
        if (mask.width(), mask.height()) != (grid.width, grid.height) {
            let (width, height) = (grid.width, grid.height);
            let values = mask.bits().len();
            return Err(SampledFieldError {
                width,
                height,
                values,
            }
            .into());
        }
        let values = distance_transform(mask, metric, progress)?;
        Ok(Self { grid, values })
    }

    /// The exact Euclidean distance to the edges of `regions`. A design may
    /// reach beyond the grid: its boundary is where it is, not at the frame.
    ///
    /// Time grows with the number of cells, and hardly with that of edges.
    ///
    /// # Errors
    /// Where the grid is none, or the work was cancelled.
    pub fn from_regions(
        regions: &Regions,
        grid: Grid,
        progress: &dyn Progress,
    ) -> Result<Self, FieldError> {
        grid.check()?;
        // In the grid's own units: distances are counted in cells.
        let edges = inside::edges(regions, &grid);
        let mut values = polygon_distance::distances(&edges, &grid, progress)?;
        for (value, inside) in values.iter_mut().zip(inside::inside(&edges, &grid)) {
            if !inside {
                *value = 0.0 - *value; // 0 stays 0 and does not become −0
            }
        }
        Self::new(grid, values)
    }

    /// The distance transform of the cells whose centre is inside `regions`:
    /// the paper's way, with a staircase for a boundary.
    ///
    /// # Errors
    /// Where the grid is none, no cell's centre is inside, or the work was
    /// cancelled.
    pub fn from_raster(
        regions: &Regions,
        grid: Grid,
        metric: Metric,
        progress: &dyn Progress,
    ) -> Result<Self, FieldError> {
        let mask = Mask::from_regions(regions, &grid)?;
        Self::from_mask(&mask, grid, metric, progress)
    }

    /// The grid whose cells the distances are counted in.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Values at the cells' centres, row-major, the lowest row first.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The values as a lattice that can be read between its samples.
    #[must_use]
    pub fn samples(&self) -> SampledField<'_> {
        SampledField::of_grid(&self.grid, &self.values)
    }

    /// The bilinear value, in cells, at a point of the plane; beyond the
    /// outermost samples it is theirs.
    #[must_use]
    pub fn value(&self, p: DVec2) -> f64 {
        let p = self.grid.lattice_from_plane(p);
        self.samples().bilinear(p.x, p.y)
    }
}

#[cfg(test)]
mod tests;
