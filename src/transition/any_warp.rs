//! The warp that a transition holds, and how it was come by.

use super::note::TransitionNote;
use super::solution_cache::KeyedSolution;
use crate::correspondence::{PointPair, RegionMatch};
use crate::warp::{
    AlongBlend, Arap, BoundaryPaths, IdentityWarp, RigidElasticWarp, StaggeredArap, Warp,
};
use std::sync::Arc;

/// The warp that a transition holds.
#[derive(Clone, Debug)]
pub(super) enum AnyWarp {
    /// Nothing moves.
    Still(IdentityWarp),
    /// Boundary points alone.
    Paths(Arc<BoundaryPaths>),
    /// Rigid parts: of solids, or of the whole frame.
    Rigid(Arap),
    /// Rigid parts of solids, some in their own time.
    Staggered(StaggeredArap),
    /// Rigid parts of the frame behind the motion that they have in common.
    Turned(RigidElasticWarp<Arap>),
    /// Rigid parts of many designs.
    Along(AlongBlend),
    /// Lines, scattered points or lattices, on a grid of the plane.
    Plane(Arc<dyn Warp>),
}

impl AnyWarp {
    pub fn as_warp(&self) -> &dyn Warp {
        match self {
            Self::Still(still) => still,
            Self::Paths(paths) => paths.as_ref(),
            Self::Rigid(arap) => arap,
            Self::Staggered(warp) => warp,
            Self::Turned(turned) => turned,
            Self::Along(warp) => warp,
            Self::Plane(warp) => warp.as_ref(),
        }
    }

    /// The same warp, for a film to keep.
    pub fn shared(&self) -> Arc<dyn Warp> {
        match self {
            Self::Still(still) => Arc::new(*still),
            Self::Paths(paths) => Arc::clone(paths) as Arc<dyn Warp>,
            Self::Rigid(arap) => Arc::new(arap.clone()),
            Self::Staggered(warp) => Arc::new(warp.clone()),
            Self::Turned(turned) => Arc::new(turned.clone()),
            Self::Along(warp) => Arc::new(warp.clone()),
            Self::Plane(warp) => Arc::clone(warp),
        }
    }

    /// The rigid parts, all in the time of the whole; of those behind a common
    /// motion as they are at rest.
    pub fn arap(&self) -> Option<&Arap> {
        match self {
            Self::Rigid(arap) => Some(arap),
            Self::Staggered(warp) => Some(warp.arap()),
            Self::Turned(turned) => Some(turned.at_rest()),
            Self::Still(_) | Self::Paths(_) | Self::Along(_) | Self::Plane(_) => None,
        }
    }
}

/// A warp, and how it was come by.
#[derive(Clone, Debug)]
pub(super) struct BuiltWarp {
    pub warp: AnyWarp,
    /// How the outlines of solids were matched, where they were.
    pub matched: Option<RegionMatch>,
    /// What was found for outlines, where they were matched.
    pub kept: Option<Arc<KeyedSolution>>,
    /// The pins that were found for a warp of the plane, where nobody set any.
    pub automatic: Vec<PointPair>,
    /// What was done otherwise than asked.
    pub notes: Vec<TransitionNote>,
}

impl From<AnyWarp> for BuiltWarp {
    fn from(warp: AnyWarp) -> Self {
        Self {
            warp,
            matched: None,
            kept: None,
            automatic: Vec::new(),
            notes: Vec::new(),
        }
    }
}
