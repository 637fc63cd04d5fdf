//! Geometry of the plane: points, matrices, polygons, regions and exact predicates.
//!
//! All coordinates are `f64` and **y points up**; images and SVG are flipped only where they are
//! read and written. Angles are in radians, counter-clockwise positive.

mod bounds;
mod crossings;
mod edge_bvh;
mod fit;
mod inset;
mod overshoot;
mod point_contacts;
mod polar;
mod predicates;
mod range;
mod region;
mod repair;
mod ring;
mod segment;
mod side;
mod similarity;
mod sliver;
mod turning;

pub use bounds::Bounds;
pub use crossings::{EdgeCrossing, RingEdge, count_crossings, crossings};
pub(crate) use edge_bvh::EdgeBvh;
pub(crate) use fit::{SimilarityFit, fit_affine};
pub use glam::{DAffine2, DMat2, DVec2};
pub(crate) use glam::{DMat3, DVec3};
pub(crate) use inset::{inradius, inset};
pub(crate) use overshoot::{excess_variation, max_overshoot};
pub use polar::{PolarDecomposition, SymmetricEigen};
pub(crate) use predicates::lexicographic;
pub use predicates::{orient2d, twice_signed_area};
pub(crate) use range::{ApproxPoint, RANGE_MESSAGE};
pub use range::{DesignSizeError, MAX_COORDINATE, MIN_SIZE, is_in_range};
pub use region::{FillRule, Region, Regions, RegionsError};
pub use repair::Repairs;
pub use ring::{Ring, RingError, perimeter, ring_edges, signed_area, winding};
pub(crate) use segment::ray_hit_parameter;
pub use segment::{
    distance_squared_to_segment, nearest_segment_parameter, segments_cross, segments_touch,
};
pub use side::{Side, SourceTarget};
pub use similarity::{Similarity, SimilarityError};
pub(crate) use turning::total_turning;
