//! Correspondence: pairs the boundary points, parts and holes of two designs.
//!
//! Parts and holes are paired by an optimal assignment. Boundaries are matched by a cyclic dynamic
//! program over all starting points ([`match_curves`]), with the user's pins (pairs of
//! corresponding points) as hard constraints. A [`BoundaryMatch`] gives both polygons the same
//! number of corresponding vertices ([`BoundaryMatch::polygons`]). [`match_regions`] does all of
//! this for two designs, and also handles parts and holes that exist in only one of them.

mod boundary;
mod boundary_match;
mod congruent;
mod curve;
mod curve_problem;
mod cyclic;
mod features;
mod inner_descriptors;
mod inner_distance;
mod inner_distance_match;
mod knot_order;
pub(crate) mod looks;
mod monotone_path;
mod options;
mod pairing;
mod path_grid;
mod pins;
mod poses;
mod proportional_map;
mod regions;
mod samples;
mod settings;
mod shared_polygons;
mod solve;
#[cfg(test)]
mod tests;
mod thickness;

pub use boundary::match_curves;
pub use boundary_match::BoundaryMatch;
pub use curve::{BoundaryCurve, CurveLengthError};
pub use options::{MatchError, MatchOptions};
pub use pairing::PairError;
pub use pins::{Pin, PinError};
pub(crate) use regions::{
    HolePolicy, MatchPlan, PartAppearance, PartAppearances, PartGroup, paired_parts,
};
pub use regions::{
    MatchNote, POINT_SIZE, PieceMatch, RegionMatch, RegionMatchError, RingKind, RingMatch,
    match_regions,
};
pub use settings::{
    HoleRule, LinePair, MatchSettings, MatchSettingsError, PartRule, PointPair, RingCut,
    UnmatchedPart,
};
pub use shared_polygons::SharedPolygons;
