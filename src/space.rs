//! Many designs at once: every blend of them, and the map in which one walks between
//! them.
//!
//! A blend is weights over the designs that sum to one. A pair is the blend of two
//! with the weights (1 − t, t); a [`Sequence`](crate::transition::Sequence) goes along
//! edges of the space, a map through all of it.
//!
//! - `build`: from designs to a [`DesignSpace`]: as rigid parts of one common mesh where they
//!   have one, and else as distance fields; `pictures`: as pictures, mixed where the
//!   features that all have lie between theirs
//! - `blend`: the space and its moments; `spread`: weights all over it
//! - `likeness`: how unlike the designs are, two at a time
//! - `map`, `layout`: where the designs are on a map, and what there is between them
//! - `path`, `film`: a path over the map, and the film along it, by a smooth `course` of
//!   weights; `steered`: whichever blend
//!   it is told
//!
//! Guaranteed: each design at its own corner, to the last bit; the order of the designs
//! has no influence but by rounding on what is between them once the hub of a common
//! mesh is chosen. Everything that can fail fails while a space is built.

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
pub use path::{MapCurve, MapPath, Waypoint, thinned};
pub use steered_transition::SteeredTransition;
pub use weight_samples::spread;
