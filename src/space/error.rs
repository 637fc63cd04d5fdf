//! Why there is no space, and what was done otherwise than asked.

use crate::compatible::FamilyError;
use crate::io::sanitize::SanitizedLine;
use crate::transition::BuildError;
use crate::warp::ArapError;
use crate::work::progress::Cancelled;

/// Why designs span no space.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// One design, or none.
    #[error("a space needs two designs or more, and there are {0}")]
    TooFew(usize),
    /// The designs have no common mesh.
    #[error("as rigid parts these designs have no common mesh: {0}; choose fields")]
    NoFamily(FamilyError),
    /// There is nothing to go along.
    #[error("there is no such way: a path needs two stops or more, on a map of these designs")]
    NoPath,
    /// Two designs do not go together, or a field cannot be made.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The blend as rigid parts failed.
    #[error(transparent)]
    Arap(#[from] ArapError),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What was done otherwise than asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceNote {
    /// They are blended as fields.
    #[error("blended as fields: {}", SanitizedLine(.0))]
    AsFields(String),
    /// Pins and lines that do not lead on from design to design.
    #[error("{0} pins and lines are of some of the pictures alone, and lead nothing here")]
    LoneFeatures(usize),
    /// Colours of their own are left out.
    #[error("in the colours of the map: the designs' own are not blended")]
    OneColour,
}
