//! Why a drawing gives no outline, the limits that errors name, and places in
//! a file.

use crate::design::flatten::TooManyPoints;
use crate::design::note::OtherKinds;
use crate::geometry::{DVec2, RegionsError};
use std::fmt;

/// Most objects, and most curves after blocks are copied. Some hundred bytes
/// each: more would fill a small machine's memory.
pub(super) const MAX_OBJECTS: usize = 1_000_000;
/// Most blocks in blocks. Placing them recurses, and a block in itself
/// must end somewhere.
pub(super) const MAX_DEPTH: usize = 16;

/// Why a drawing gives no outline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DxfError {
    /// A group code that is none.
    #[error("{0}: there is no group code where one should be; save the drawing again as DXF")]
    Code(DxfPlace),
    /// The file breaks off.
    #[error("{0}: the file ends in the middle; save or copy it again")]
    Truncated(DxfPlace),
    /// A number that is none, or beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("{0}: there is no number from -1e18 to 1e18 here; correct it, or scale the drawing")]
    Number(DxfPlace),
    /// An object whose parts do not fit.
    #[error("{at}: {kind} cannot be used: {what}; correct or remove it")]
    Broken {
        /// Where the object begins.
        at: DxfPlace,
        /// Its kind, as the file calls it.
        kind: String,
        /// What is wrong.
        what: &'static str,
    },
    /// Objects, copies included, without end.
    #[error(
        "the drawing has more than {MAX_OBJECTS} objects, copies of blocks included; save only its outlines"
    )]
    TooMany,
    /// Blocks in blocks without end.
    #[error(
        "blocks lie in blocks more than {MAX_DEPTH} levels deep, or a block in itself; explode them"
    )]
    TooDeep,
    /// Curves into absurdly many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// There is nothing to read.
    #[error("there is no line, arc or curve in the drawing{0}; draw or explode the outlines")]
    Nothing(OtherKinds),
    /// Curves, but no ring.
    #[error(
        "none of the curves close: one of {count} ends at ({}, {}) and nothing goes on there; join the curves end to end",
        at.x, at.y
    )]
    Open {
        /// How many curves there are.
        count: usize,
        /// A loose end.
        at: DVec2,
    },
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Where something stands in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DxfPlace {
    /// A line of text, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
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
