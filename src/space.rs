//! Design spaces: blends of any number of designs, and maps on which every place is a blend.
//!
//! A blend is given by weights, one per design, that sum to one. A transition between two designs
//! is the blend with weights (1 − t, t). A [`Sequence`](crate::transition::Sequence) follows edges
//! of the space, that is, blends of two designs; a path over a map crosses the interior of the
//! space.
//!
//! - `build`: builds a [`DesignSpace`] as rigid parts of a common mesh if there is one, otherwise
//!   as distance fields; `picture_space`: blends pictures, warped by features common to all of them
//! - `blend`: the space and its frames; `weight_samples`: weights spread over the space
//! - `design_distance`: how dissimilar each pair of designs is
//! - `map`, `layout`: positions of the designs on a map, and the weights between them
//! - `path`, `path_transition`: paths over a map and the films along them, with weights smoothed by
//!   `weight_polynomials`; `steered_transition`: a transition whose weights are set from outside
//!
//! Weight 1 on one design reproduces it exactly. A common mesh starts from a hub, the design with
//! which all others are matched. For a given hub, the order of the designs affects blends only by
//! rounding. Errors occur only while a space or a path is built, never in a frame.

mod blend;
mod build;
mod design_distance;
mod error;
mod layout;
mod map;
mod path;
mod path_transition;
mod picture_space;
mod steered_transition;
#[cfg(test)]
mod tests;
mod weight_polynomials;
mod weight_samples;

pub use blend::{DesignSpace, SpaceFrame};
pub use build::SpaceSpec;
pub use design_distance::DesignDistances;
pub use error::{SpaceError, SpaceNote};
pub use layout::MapLayout;
pub use map::WeightMap;
pub use path::{MapCurve, MapPath, Waypoint, simplify_polyline};
pub use steered_transition::SteeredTransition;
pub use weight_samples::weight_sample;
