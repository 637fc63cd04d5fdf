//! Errors of the DXF importer and the limits that they mention.

use crate::design::flatten::TooManyPoints;
use crate::design::note::{DxfPlace, LeftOut};
use crate::geometry::RegionsError;

/// Maximum number of entities and polyline vertices in the file (resource limit: a few hundred
/// bytes each). While blocks are expanded, one object is counted for each path and each control
/// point, and two for each block copy; twice this maximum is then allowed.
pub(super) const MAX_OBJECTS: usize = 1_000_000;

/// Maximum nesting depth of blocks (resource limit: expansion recurses).
pub(super) const MAX_DEPTH: usize = 16;

/// Returns an error if a count exceeds its maximum.
pub(super) fn check_count(count: usize, max: usize) -> Result<(), DxfError> {
    match count > max {
        true => Err(DxfError::TooMany),
        false => Ok(()),
    }
}

/// Error of importing a DXF drawing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DxfError {
    /// A group code is missing or invalid.
    #[error("{0}: a group code is missing or invalid; save the drawing as DXF again")]
    Code(DxfPlace),
    /// The file is incomplete.
    #[error("{0}: the file is incomplete; save or copy it again")]
    Truncated(DxfPlace),
    /// The drawing has too many objects, including copies of blocks.
    #[error(
        "the drawing has more than {MAX_OBJECTS} objects, including copies of blocks; save only its outlines"
    )]
    TooMany,
    /// The curves need too many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// Nothing of the drawing can be used, or all of it lies in one point.
    #[error("the drawing has nothing that can be drawn{0}")]
    Nothing(LeftOut),
    /// The outlines enclose no area.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Fault of one entity, which is then left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EntityFault {
    /// Position of the faulty value; `None` for a fault of the whole entity.
    pub at: Option<DxfPlace>,
    /// Fault, as worded in the message.
    pub reason: &'static str,
}

impl From<&'static str> for EntityFault {
    fn from(reason: &'static str) -> Self {
        Self { at: None, reason }
    }
}
