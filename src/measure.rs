//! Quality measures of meshes, films and design spaces, and the check that finds defects.
//!
//! - [`MeshReport`], of a compatible mesh: angles, Steiner points, boundary stretch, and distortion
//!   of the mapping between its two embeddings
//! - [`FilmReport`], of a transition sampled over t: folds, self-crossings, distortion beyond that
//!   of the target, area, perimeter, turning, pieces, holes, and the vertices' travel and
//!   acceleration without the rigid motion; [`FilmReport::series`] gives each quantity against t
//! - [`Verdict`]: the defects of a film, each with its place, cause and remedy
//! - [`SpaceReport`], of a design space: the blends of each pair of designs, the blend of all
//!   designs with equal weights, and blends spread over all weights
//! - [`BlendMeasures`]: one blend of several designs; [`MapLandscape`]: the blends of a whole map
//! - [`FilmRating`]: one rating per film, to choose among methods ([`build_best_method`])
//!
//! Films are measured at samples of t; a defect between two samples is missed.

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
pub use film_report::{FilmReport, FilmSample, film_report};
pub use map_landscape::{MapLandscape, MapMeasure};
pub use mesh_report::{MeshReport, mesh_report};
pub use motion::MotionReport;
pub use rating::{FilmRating, build_best_method};
pub use space_report::{BlendStatistics, EdgeReport, SpaceReport, space_report};
pub use time_series::Quantity;
pub use verdict::{Finding, FindingCause, FindingKind, Remedy, SettingChange, Verdict};
