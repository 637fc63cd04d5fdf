//! Warps: mappings that say where each point of the designs lies at blend parameter t.
//!
//! There are six kinds ([`WarpKind`]): rigid parts, boundary paths, line pairs, scattered points,
//! B-spline lattices, and no motion at all. A [`Warp`] is built once, which can fail. It creates
//! [`Placer`]s, which evaluate it at one t after another. A placer owns its memory and cannot fail.
//! Warps are independent of the content they carry (solids, distance fields or pictures).
//!
//! The frame is the visible rectangle of the plane, not an image of the film.

mod arap;
mod elementary;
mod features;
pub mod homotopy;
mod identity;
mod kind;
mod lattice;
mod lines;
mod many_designs;
mod part_path;
mod paths;
mod plane;
mod rigid_elastic;
mod rigid_motion;
mod scattered;
mod staggered;

pub use arap::{
    AlongBlend, AngleError, Arap, ArapBlend, ArapError, ArapOptions, ArapPath, BlendPlacer,
    FaceWeights, Ridge, TimeWindow,
};
pub(crate) use arap::{Guard, OutlineParameters};
pub use features::{FeatureError, LINE_SAMPLES, MAX_FEATURES};
pub use identity::IdentityWarp;
pub use kind::{CellLabels, CellSupport, WarpKind, WarpLabels};
pub use lattice::{Lattice, LatticeError, LatticeOptions, MAX_EXTRA_LEVELS, MAX_LATTICE_CELLS};
pub use lines::{LineInterpolation, LineOptions, LineWarp, LinesError};
pub use many_designs::{ManyFeatures, ManyPlaces, ManyWarp, PlaneBlend};
pub use paths::{BoundaryPaths, PathOptions, PathsError, RingPair, VertexPath};
pub use plane::{GridWarp, PlaneGrid, PlaneWarp};
pub use rigid_elastic::{RigidElasticPlaneWarp, RigidElasticWarp};
pub use rigid_motion::{CommonRigidMotion, FeatureTravel};
pub use scattered::{RadialBasis, ScatteredError, ScatteredOptions, ScatteredWarp};
pub use staggered::{PartClock, StaggeredArap};

use crate::geometry::DVec2;
use std::fmt::Debug;
use std::sync::Arc;

/// A triangle mesh placed in the frame at one t, with texture coordinates in both designs.
///
/// This is the interface between warps and contents. The lists `in_frame`, `in_source` and
/// `in_target` hold one point per vertex.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Vertex indices of each face; the same at every t.
    pub faces: Arc<[[u32; 3]]>,
    /// Position of each vertex in the frame at t.
    pub in_frame: Vec<DVec2>,
    /// For each vertex, the point of the source design that is shown at the vertex.
    pub in_source: Vec<DVec2>,
    /// For each vertex, the point of the target design that is shown at the vertex.
    pub in_target: Vec<DVec2>,
}

impl Placement {
    /// Returns the placement at t = 0, with each vertex at its source position.
    pub(crate) fn of_source(faces: Arc<[[u32; 3]]>, source: &[DVec2], target: &[DVec2]) -> Self {
        Self {
            faces,
            in_frame: source.to_vec(),
            in_source: source.to_vec(),
            in_target: target.to_vec(),
        }
    }
}

/// Summary of the features (point pairs and sample points of line pairs) that a warp does not map
/// to their positions in the designs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissedFeatures {
    /// Number of missed features; every sample point of a line counts as one.
    pub count: usize,
    /// Distance between the image of the worst missed feature and its position in a design, in
    /// plane units.
    pub distance: f64,
    /// Position in the frame of the worst missed feature.
    pub place: DVec2,
    /// Whether the warp forbids folds. If so, allowing folds may reduce the distance.
    pub fold_free: bool,
}

/// A warp that is built and can be evaluated at any t.
pub trait Warp: Debug + Send + Sync {
    /// Returns an evaluator with its own memory, placed at t = 0.
    fn placer(&self) -> Placer;

    /// Returns the times at which a part starts, stops or changes its speed abruptly.
    ///
    /// Between two neighbouring times every vertex moves smoothly. The times are unsorted and may
    /// include 0 and 1.
    fn break_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns a summary of the features that the warp misses at `t` by more than its tolerance, or
    /// `None` if it misses none or does not measure them.
    fn missed_features(&self, _t: f64) -> Option<MissedFeatures> {
        None
    }
}

/// Evaluator of a warp. Evaluation neither allocates nor fails.
pub struct Placer {
    placement: Placement,
    update: Box<PlacementUpdate>,
}

/// Function that moves a placement to a given t. It owns the memory for this computation.
type PlacementUpdate = dyn FnMut(f64, &mut Placement) + Send + Sync;

impl Placer {
    pub(crate) fn new(
        placement: Placement,
        mover: impl FnMut(f64, &mut Placement) + Send + Sync + 'static,
    ) -> Self {
        Self {
            placement,
            update: Box::new(mover),
        }
    }

    /// Moves the placement to `t`; values outside [0, 1] extrapolate.
    pub fn place(&mut self, t: f64) {
        (self.update)(t, &mut self.placement);
    }

    /// Returns a placer that calls `first` and, if that returns `false`, evaluates this placer
    /// instead.
    ///
    /// `first` returns `true` if it has moved the placement.
    pub(crate) fn with_override(
        mut self,
        mut first: impl FnMut(f64, &mut Placement) -> bool + Send + Sync + 'static,
    ) -> Self {
        Self::new(self.placement, move |t, placement| {
            if !first(t, placement) {
                (self.update)(t, placement);
            }
        })
    }

    /// Returns the placement at the most recent `t`.
    #[must_use]
    pub fn placement(&self) -> &Placement {
        &self.placement
    }
}

impl Debug for Placer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.placement.fmt(f)
    }
}
