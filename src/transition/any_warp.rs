//! The warp of a transition, and how it was determined.

use super::note::TransitionNote;
use super::solution_cache::KeyedSolution;
use crate::correspondence::{PointPair, RegionMatch};
use crate::warp::{
    AlongBlend, Arap, BoundaryPaths, IdentityWarp, RigidElasticWarp, StaggeredArap, Warp,
};
use std::sync::Arc;

/// The warp of a transition, of any kind.
#[derive(Clone, Debug)]
pub(super) enum AnyWarp {
    /// Nothing moves.
    Still(IdentityWarp),
    /// Only boundary points move.
    Paths(Arc<BoundaryPaths>),
    /// Rigid parts of solids, or of the whole frame.
    Rigid(Arap),
    /// Rigid parts of solids, some with a timing of their own.
    Staggered(StaggeredArap),
    /// Rigid parts of the frame, relative to a common rigid motion.
    Turned(RigidElasticWarp<Arap>),
    /// Rigid parts between blends of many designs.
    Along(AlongBlend),
    /// Lines, scattered points or lattices, evaluated on a grid of the plane.
    Plane(Arc<dyn Warp>),
}

impl AnyWarp {
    /// Returns the warp as a trait object.
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

    /// Returns the warp as shared data, for a recording to own.
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

    /// Returns the interpolation of rigid parts, without part timings and relative to the common
    /// motion, if there are any.
    pub fn arap(&self) -> Option<&Arap> {
        match self {
            Self::Rigid(arap) => Some(arap),
            Self::Staggered(warp) => Some(warp.arap()),
            Self::Turned(turned) => Some(turned.at_rest()),
            Self::Still(_) | Self::Paths(_) | Self::Along(_) | Self::Plane(_) => None,
        }
    }
}

/// A warp, and how it was determined.
#[derive(Clone, Debug)]
pub(super) struct BuiltWarp {
    pub warp: AnyWarp,
    /// The match of the outlines, if outlines were matched.
    pub matched: Option<RegionMatch>,
    /// The solved motion of the match, for documents to cache.
    pub solution: Option<Arc<KeyedSolution>>,
    /// Automatic pins of a plane warp, if the user has set none.
    pub automatic: Vec<PointPair>,
    /// Deviations from the request.
    pub notes: Vec<TransitionNote>,
}

impl From<AnyWarp> for BuiltWarp {
    fn from(warp: AnyWarp) -> Self {
        Self {
            warp,
            matched: None,
            solution: None,
            automatic: Vec::new(),
            notes: Vec::new(),
        }
    }
}
