//! The warp of a transition, with the match and the solved motion from which it was built.

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
    Identity(IdentityWarp),
    /// Only boundary points move.
    Paths(Arc<BoundaryPaths>),
    /// Rigidity-preserving motion of solid designs, or of a triangle mesh that covers the whole
    /// frame and carries a distance field or a picture.
    Rigid(Arap),
    /// Rigid parts of solids, some of which have their own timing.
    Staggered(StaggeredArap),
    /// Motion of a triangle mesh that covers the whole frame, composed of two motions: the rigid
    /// motion that all pins and lines have in common, and the rigidity-preserving motion of the
    /// mesh relative to it.
    RigidElastic(RigidElasticWarp<Arap>),
    /// Rigid parts that move from one blend of many designs to another.
    Blend(AlongBlend),
    /// Warp of the whole plane that follows lines, scattered points or a lattice; evaluated at the
    /// points of a grid.
    Plane(Arc<dyn Warp>),
}

impl AnyWarp {
    /// Returns the warp as a trait object.
    pub fn as_warp(&self) -> &dyn Warp {
        match self {
            Self::Identity(still) => still,
            Self::Paths(paths) => paths.as_ref(),
            Self::Rigid(arap) => arap,
            Self::Staggered(warp) => warp,
            Self::RigidElastic(turned) => turned,
            Self::Blend(warp) => warp,
            Self::Plane(warp) => warp.as_ref(),
        }
    }

    /// Returns the warp as an [`Arc`], so that a recording can own it.
    pub fn to_shared(&self) -> Arc<dyn Warp> {
        match self {
            Self::Identity(still) => Arc::new(*still),
            Self::Paths(paths) => Arc::clone(paths) as Arc<dyn Warp>,
            Self::Rigid(arap) => Arc::new(arap.clone()),
            Self::Staggered(warp) => Arc::new(warp.clone()),
            Self::RigidElastic(turned) => Arc::new(turned.clone()),
            Self::Blend(warp) => Arc::new(warp.clone()),
            Self::Plane(warp) => Arc::clone(warp),
        }
    }

    /// Returns the rigidity-preserving interpolation of the warp, without part timings; `None` if
    /// the warp has none. For [`Self::RigidElastic`], the interpolation is relative to the common
    /// rigid motion.
    pub fn arap(&self) -> Option<&Arap> {
        match self {
            Self::Rigid(arap) => Some(arap),
            Self::Staggered(warp) => Some(warp.arap()),
            Self::RigidElastic(turned) => Some(turned.rest_warp()),
            Self::Identity(_) | Self::Paths(_) | Self::Blend(_) | Self::Plane(_) => None,
        }
    }
}

/// A warp, with the match, the solution and the automatic pins from which it was built.
#[derive(Clone, Debug)]
pub(super) struct BuiltWarp {
    pub warp: AnyWarp,
    /// The match of the outlines, if outlines were matched.
    pub matched: Option<RegionMatch>,
    /// The solved motion of the matched outlines. Documents store it, so that it need not be solved
    /// again.
    pub solution: Option<Arc<KeyedSolution>>,
    /// Automatic pins of a plane warp, if the user has set none.
    pub automatic_pins: Vec<PointPair>,
    /// Notes on deviations from the request.
    pub notes: Vec<TransitionNote>,
}

impl From<AnyWarp> for BuiltWarp {
    fn from(warp: AnyWarp) -> Self {
        Self {
            warp,
            matched: None,
            solution: None,
            automatic_pins: Vec::new(),
            notes: Vec::new(),
        }
    }
}
