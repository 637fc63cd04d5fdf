//! Errors of the DXF importer, the limits that they mention, and positions in a file.

use crate::design::flatten::TooManyPoints;
use crate::design::note::OtherKinds;
use crate::geometry::{DVec2, RegionsError};
use std::fmt;

/// Maximum number of entities and polyline vertices in the file (resource limit: a few hundred
/// bytes each). While blocks are expanded, one object is counted for each path and each control
/// point, and two for each block copy; twice this maximum is then allowed.
pub(super) const MAX_OBJECTS: usize = 1_000_000;

/// Maximum nesting depth of blocks (resource limit: expansion recurses, and a block may contain
/// itself).
pub(super) const MAX_DEPTH: usize = 16;

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
    /// A value is not a number, or its absolute value exceeds [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("{0}: expected a number from -1e18 to 1e18; correct it or scale the drawing")]
    Number(DxfPlace),
    /// An entity has inconsistent data.
    #[error("{at}: {kind} cannot be used: {what}; correct or remove it")]
    Broken {
        /// Position of the entity.
        at: DxfPlace,
        /// Type name as written in the file.
        kind: String,
        /// Fault of the entity, as worded in the message.
        what: &'static str,
    },
    /// The drawing has too many objects, including copies of blocks.
    #[error(
        "the drawing has more than {MAX_OBJECTS} objects, including copies of blocks; save only its outlines"
    )]
    TooMany,
    /// Blocks are nested too deeply or contain themselves.
    #[error(
        "blocks are nested more than {MAX_DEPTH} levels deep, or a block contains itself; explode them"
    )]
    TooDeep,
    /// The curves need too many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// The drawing has no supported curves, or all of them lie in one point. Holds the number of
    /// ignored entities of each type.
    #[error("the drawing has no lines, arcs or curves{0}; draw or explode the outlines")]
    Nothing(OtherKinds),
    /// The curves form no closed ring.
    #[error(
        "no curves form a closed outline: one of {count} has a free end at ({}, {}); join the curves end to end",
        at.x, at.y
    )]
    Open {
        /// Number of open curves in the drawing.
        count: usize,
        /// Free end of one of the curves.
        at: DVec2,
    },
    /// The outlines enclose no area.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Position in a DXF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DxfPlace {
    /// Line of a text file, counted from 1.
    Line(usize),
    /// Byte offset in a binary file, counted from 0.
    Byte(usize),
}

impl fmt::Display for DxfPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}
