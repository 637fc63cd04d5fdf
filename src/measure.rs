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
//! - [`BlendMeasures`]: one blend of many designs; [`MapLandscape`]: all over a map.
//! - [`FilmRating`]: how much trouble a film is, to choose among methods ([`auto`]).
//!
//! Measures are taken at samples: a fold between two samples is not seen.

mod blend_report;
mod distortion;
mod film_report;
mod map_landscape;
mod mesh_report;
mod motion;
mod overshoot;
mod rating;
mod space_report;
mod stretch;
#[cfg(test)]
mod tests;
mod time_series;
mod verdict;

pub use crate::geometry::{EdgeCrossing, RingEdge, count_crossings, crossings};
pub use blend_report::{BlendMeasures, BlendReport, BlendSampler};
pub use distortion::{Distortion, Distribution, distortion};
pub use film_report::{FilmReport, FilmSample, film};
pub use map_landscape::{MapLandscape, MapMeasure};
pub use mesh_report::{MeshReport, mesh};
pub use motion::MotionReport;
pub use rating::{FilmRating, auto};
pub use space_report::{BlendStatistics, EdgeReport, SpaceReport, space};
pub use time_series::Quantity;
pub use verdict::{Finding, FindingCause, FindingKind, Remedy, SettingChange, Verdict};
