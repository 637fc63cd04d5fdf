//! Signed distance fields: grids, masks, distance transforms, contours.
//!
//! A field is positive inside a design and negative outside, **in cells of its
//! grid**: ε and the threshold of a blend mean nothing without the grid.

pub mod contour;
mod samples;

pub use samples::{Samples, SamplesError};
