//! Warps: where each material point is at time t. One file per row of the
//! table of cells.
//!
//! A [`Warp`] is built once, and building can fail. It hands out [`Placer`]s,
//! which own all memory a frame needs; placing allocates nothing and cannot
//! fail. Warps know nothing of contents.

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

/// What joins warps and contents: faces, and for each vertex its place in the
/// frame at t, in the source and in the target. All three have the same
/// length.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Vertex indices, three a face; the same at every t.
    pub faces: Arc<[[u32; 3]]>,
    /// Where each vertex is seen at t.
    pub in_frame: Vec<DVec2>,
    /// The point of the source that is there.
    pub in_source: Vec<DVec2>,
    /// The point of the target that is there.
    pub in_target: Vec<DVec2>,
}

impl Placement {
    /// At t = 0: each vertex is where it is in the source.
    pub(crate) fn of_source(faces: Arc<[[u32; 3]]>, source: &[DVec2], target: &[DVec2]) -> Self {
        Self {
            faces,
            in_frame: source.to_vec(),
            in_source: source.to_vec(),
            in_target: target.to_vec(),
        }
    }
}

/// Features that a warp does not lead to where they belong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissedFeatures {
    /// How many; a line counts as its samples.
    pub count: usize,
    /// How far the worst one is off in a design, in units of the plane.
    pub by: f64,
    /// Where the worst one ought to be in the frame.
    pub place: DVec2,
    /// Folds were not allowed; with them it might be met.
    pub unfolded: bool,
}

/// A row of the table, ready to be played.
pub trait Warp: Debug + Send + Sync {
    /// A placer with memory of its own, at t = 0.
    fn placer(&self) -> Placer;

    /// The times within (0, 1) at which something sets out, arrives or changes its
    /// pace: between them every vertex moves smoothly. In no order.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The features that are not where they belong at `t`; none where all
    /// are, to the warp's own tolerance.
    fn missed(&self, _t: f64) -> Option<MissedFeatures> {
        None
    }
}

/// Evaluates a warp. Needs no allocation and cannot fail.
pub struct Placer {
    placement: Placement,
    mover: Box<PlacementUpdate>,
}

/// Moves a placement to a t, and owns all memory that this takes.
type PlacementUpdate = dyn FnMut(f64, &mut Placement) + Send + Sync;

impl Placer {
    pub(crate) fn new(
        placement: Placement,
        mover: impl FnMut(f64, &mut Placement) + Send + Sync + 'static,
    ) -> Self {
        Self {
            placement,
            mover: Box::new(mover),
        }
    }

    /// Moves the placement to `t`; outside [0, 1] it extrapolates.
    pub fn place(&mut self, t: f64) {
        (self.mover)(t, &mut self.placement);
    }

    /// A placer that asks `first` to move the placement, and does it itself where that
    /// says that it did not.
    pub(crate) fn after(
        mut self,
        mut first: impl FnMut(f64, &mut Placement) -> bool + Send + Sync + 'static,
    ) -> Self {
        Self::new(self.placement, move |t, placement| {
            if !first(t, placement) {
                (self.mover)(t, placement);
            }
        })
    }

    /// The placement at the last `t`.
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
