//! Which point of one design is which of the other.
//!
//! Parts and holes are paired by an assignment, boundaries by a cyclic dynamic
//! program over all starting points ([`match_curves`]), with pins as hard
//! constraints. A [`BoundaryMatch`] gives both polygons the same number of corresponding
//! vertices ([`BoundaryMatch::polygons`]). [`match_regions`] does all of that
//! for two designs, and gives a partner to what one of them has alone.

mod assignment;
mod boundary;
mod boundary_match;
mod congruent;
mod curve;
mod cyclic;
mod features;
mod in_order;
mod inner_distance;
mod inner_match;
mod inner_rows;
mod options;
mod pairing;
mod path_grid;
mod pins;
mod polygons;
mod poses;
mod problem;
mod refine;
mod regions;
mod samples;
mod settings;
mod solve;
mod straight;
#[cfg(test)]
mod tests;
mod thickness;

pub use boundary::match_curves;
pub use boundary_match::BoundaryMatch;
pub use curve::{Curve, CurveError};
pub use options::{MatchError, MatchOptions};
pub use pairing::PairError;
pub use pins::{Pin, PinError};
pub use polygons::SharedPolygons;
pub(crate) use regions::{Group, Holes, Look, Looks, Prepared, paired_parts};
pub use regions::{
    MatchNote, POINT_SIZE, PieceMatch, RegionMatch, RegionMatchError, RingKind, RingMatch,
    match_regions,
};
pub use settings::{
    HoleRule, LinePair, LonePart, Matching, PartRule, PlaceError, PointPair, RingCut,
};
