//! Quality of a mesh and of a film, in numbers and in words.
//!
//! - [`MeshReport`]: the two embeddings of a compatible mesh: angles, Steiner
//!   points, how evenly the boundary is stretched, and the distortion of the
//!   map between them.
//! - [`FilmReport`]: a transition sampled over t: folds, distortion beyond
//!   the worse end, self-crossings, how area, perimeter and turning run, pieces and
//!   holes, travel and acceleration with the rigid motion taken out; and each
//!   of them against t ([`FilmReport::series`]).
//! - [`Verdict`]: what goes wrong in a film, where, why, and what helps.
//! - [`SpaceReport`]: a space of many designs: its edges, its middle, and blends all over.
//! - [`BlendMeasures`]: one blend of many designs; [`Landscape`]: all over a map.
//! - [`Rating`]: how much trouble a film is, to choose among methods ([`auto`]).
//!
//! Measures are taken at samples: a fold between two samples is not seen.

mod blend;
mod distortion;
mod excess;
mod film;
mod landscape;
mod mesh;
mod motion;
mod rating;
mod series;
mod space;
mod stretch;
#[cfg(test)]
mod tests;
mod verdict;

pub use crate::geometry::{Crossing, RingEdge, count_crossings, crossings};
pub use blend::{BlendMeasures, BlendReport, BlendSampler};
pub use distortion::{Distortion, Distribution, distortion};
pub use film::{FilmReport, FilmSample, film};
pub use landscape::{Landscape, MapMeasure};
pub use mesh::{MeshReport, mesh};
pub use motion::Motion;
pub use rating::{Rating, auto};
pub use series::Quantity;
pub use space::{EdgeReport, SpaceReport, Spread, space};
pub use verdict::{Cause, Change, Finding, Remedy, Trouble, Verdict};
