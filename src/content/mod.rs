//! Contents: what is seen where a warp has put things. One file per column of
//! the table of cells. Contents read placements and nothing else.

mod field;
mod solid;

pub use field::{BlendSpace, FieldBlend, FieldPair, FieldPairError};
pub use solid::Solid;

use serde::{Deserialize, Serialize};

/// Which content: a column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContentKind {
    /// Regions and bars, filled.
    Solid,
    /// The contour of two blended distance fields.
    Field,
}

/// A column of the table with its data.
#[derive(Clone, Debug)]
pub enum Content {
    /// Regions and bars, filled.
    Solid(Solid),
    /// The contour of two blended distance fields.
    Field(FieldPair),
}
