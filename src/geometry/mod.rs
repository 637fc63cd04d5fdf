//! Points, matrices, polygons and exact predicates: the plane everything
//! else stands in.
//!
//! All coordinates are `f64` and **y points up**; images and SVG are flipped
//! where they are read and written, nowhere else. Angles are radians,
//! counter-clockwise positive.

mod bounds;
mod crossings;
mod edge_boxes;
mod excess;
mod fit;
mod inset;
mod pair;
mod polar;
mod predicates;
mod range;
mod region;
mod repair;
mod ring;
mod segment;
mod similarity;
mod sliver;
mod touching;
mod turning;

pub use bounds::Bounds;
pub use crossings::{Crossing, RingEdge, count_crossings, crossings};
pub(crate) use edge_boxes::EdgeBoxes;
pub(crate) use excess::{excess_between, variation_excess};
pub(crate) use fit::{Fit, affine};
pub use glam::{DAffine2, DMat2, DVec2};
pub(crate) use glam::{DMat3, DVec3};
pub(crate) use inset::{inset, inset_depth};
pub use pair::{Pair, Side};
pub use polar::{Polar, SymmetricEigen};
pub(crate) use predicates::lexicographic;
pub use predicates::{orient2d, twice_signed_area};
pub(crate) use range::{About, RANGE};
pub use range::{MAX_COORDINATE, MIN_SIZE, SizeError, is_in_range};
pub use region::{FillRule, Region, Regions, RegionsError};
pub use repair::Repairs;
pub use ring::{Ring, RingError, perimeter, ring_edges, signed_area, winding};
pub(crate) use segment::along_ray;
pub use segment::{along_segment, distance_squared_to_segment, segments_cross, segments_touch};
pub use similarity::{Similarity, SimilarityError};
pub(crate) use turning::turning;
