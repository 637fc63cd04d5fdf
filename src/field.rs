//! Signed distance fields: grids, masks, distance transforms and contours.
//!
//! A field is positive inside a design and negative outside. Its unit is **the cell of its grid**.
//! The lengths `epsilon` and `threshold` of a [`FieldBlend`](crate::content::FieldBlend) are in
//! cells, too, so the result of a blend depends on the grid. A field is computed in one of two
//! ways: as the exact distance to the edges of polygons ([`DistanceField::from_regions`]), or by
//! the distance transform of a binary image in one of four metrics ([`distance_transform`]).
//!
//! In this module, row 0 of a grid, mask or field is its lowest row.

mod chamfer;
pub mod contour;
mod distance_field;
mod euclidean;
mod grid;
mod inside;
mod mask;
mod polygon_distance;
mod sampled_field;
#[cfg(test)]
mod testing;
mod transform;

pub use distance_field::{DistanceField, FieldError};
pub use grid::{Grid, GridError};
pub use mask::{Mask, MaskError};
pub use sampled_field::{SampledField, SampledFieldError};
pub use transform::{Metric, distance_transform};
