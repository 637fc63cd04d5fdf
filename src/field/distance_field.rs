//! Signed distance fields of designs: one distance per cell of a grid.
//!
//! Guaranteed: values are positive inside and negative outside; their unit is the cell of the grid.
//! Computed from polygons, they are exact up to rounding; computed from masks, they equal the
//! brute-force minimum over all cells. Values are interpolated bilinearly between samples, as in
//! the shader that draws the stage. Not guaranteed: interpolated values are not exact distances;
//! near the medial axis they are off by up to half the diagonal of a cell.

use super::{
    Grid, GridError, Mask, MaskError, Metric, SampledField, SampledFieldError, distance_transform,
};
use super::{inside, polygon_distance};
use crate::geometry::{DVec2, Regions};
use crate::work::progress::{Cancelled, Progress};

/// Signed distances at the cell centres (samples) of a grid.
///
/// ```
/// use morphospace::field::{DistanceField, Grid};
/// use morphospace::geometry::{DVec2, FillRule, Regions};
/// use morphospace::work::progress::Silent;
///
/// let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let square = Regions::from_rings(&[square.to_vec()], FillRule::NonZero)?;
/// let grid = Grid::covering(&square.bounds(), 64, 0.5)?; // 8 cells per unit length
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

/// Errors of computing or creating a distance field.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The grid is invalid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The mask is invalid.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The number of values differs from the number of cells, or the mask has another size than the
    /// grid.
    #[error(transparent)]
    Length(#[from] SampledFieldError),
    /// A value is NaN or infinite.
    #[error("the distance at cell ({x}, {y}) is not a finite number; compute the field again")]
    NotFinite {
        /// Column of the cell, counted from 0.
        x: u32,
        /// Row of the cell, counted from 0 at the lowest row.
        y: u32,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl DistanceField {
    /// Creates a field from distances in cells, in row-major order, lowest row first.
    ///
    /// # Errors
    /// Returns an error if the grid is invalid, the number of values differs from the number of
    /// cells, or a value is not finite.
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

    /// Creates a field with the same value, clamped to the range of `f32`, at every sample. The
    /// grid must be valid.
    pub(crate) fn uniform(grid: Grid, value: f64) -> Self {
        let value = value.clamp(f32::MIN.into(), f32::MAX.into()) as f32;
        Self {
            values: vec![value; grid.width as usize * grid.height as usize],
            grid,
        }
    }

    /// Computes the distance transform of a mask, which must have the size of the grid.
    ///
    /// # Errors
    /// Returns an error if the grid is invalid, the mask has another size, or `progress` is
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

    /// Computes the exact Euclidean distances to the edges of `regions`. Edges outside the grid
    /// count, too; the border of the grid is not a boundary.
    ///
    /// The running time is proportional to the number of cells and depends little on the number of
    /// edges.
    ///
    /// # Errors
    /// Returns an error if the grid is invalid or `progress` is cancelled.
    pub fn from_regions(
        regions: &Regions,
        grid: Grid,
        progress: &dyn Progress,
    ) -> Result<Self, FieldError> {
        grid.check()?;
        // The edges are in lattice coordinates, so that distances are in cells.
        let edges = inside::lattice_edges(regions, &grid);
        let mut values = polygon_distance::distances(&edges, &grid, progress)?;
        for (value, inside) in values.iter_mut().zip(inside::inside_samples(&edges, &grid)) {
            if !inside {
                *value = 0.0 - *value; // not −value: 0 must not become −0
            }
        }
        Self::new(grid, values)
    }

    /// Computes the distance transform of the cells whose centre is inside `regions`. This is the
    /// method of the paper *Design-Space Representation through Blended Transitions*; it
    /// approximates the boundary by a staircase.
    ///
    /// # Errors
    /// Returns an error if the grid is invalid, no cell centre is inside, or `progress` is
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

    /// Grid of the field. The side length of its cells is the unit of the distances.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Values at the cell centres in row-major order, lowest row first.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Values as a [`SampledField`], which interpolates bilinearly. Its coordinates are the lattice
    /// coordinates of [`Self::grid`]: the centre of cell (i, j) is at (i, j).
    #[must_use]
    pub fn samples(&self) -> SampledField<'_> {
        SampledField::of_grid(&self.grid, &self.values)
    }

    /// Returns the bilinearly interpolated value, in cells, at a point of the plane. A point beyond
    /// the outermost samples is first clamped to their rectangle.
    #[must_use]
    pub fn value(&self, p: DVec2) -> f64 {
        let p = self.grid.lattice_from_plane(p);
        self.samples().bilinear(p.x, p.y)
    }
}

#[cfg(test)]
mod tests;
