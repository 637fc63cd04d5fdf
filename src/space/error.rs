//! Errors of building a design space, and notes on what was done differently from the request.

use crate::compatible::FamilyError;
use crate::io::sanitize::SanitizedLine;
use crate::transition::{BuildError, FittedPage};
use crate::warp::ArapError;
use crate::work::progress::Cancelled;

/// Error while building or using a design space.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// There are fewer than two designs.
    #[error("a design space needs at least two designs, but there are {0}")]
    TooFew(usize),
    /// The designs have no common mesh.
    #[error("these designs have no common mesh for rigid parts: {0}; choose distance fields")]
    NoCommonMesh(FamilyError),
    /// The path has fewer than two stops or does not belong to a map of these designs.
    #[error("there is no such path: it needs at least two stops on a map of these designs")]
    NoPath,
    /// Two designs are incompatible, or a field cannot be computed.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Preparing the blend of rigid parts failed.
    #[error(transparent)]
    Arap(#[from] ArapError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Something that was done differently from what was requested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceNote {
    /// The designs have no common mesh, for the given reason, and are blended as distance fields.
    #[error("blended as distance fields: {}", SanitizedLine(.0))]
    AsFields(String),
    /// Some pins and lines do not exist in all designs and are ignored. Holds their number.
    #[error("{0} pins and lines do not exist in all pictures and are ignored on the map")]
    UnmatchedFeatures(usize),
    /// The designs' own colours are ignored.
    #[error("shown in the colours of the map: the designs' own colours are not blended")]
    PaintIgnored,
    /// A page was scaled to fit into the page of the first design.
    #[error("{0}")]
    PageFitted(FittedPage),
}
