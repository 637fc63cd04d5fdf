//! Contents: what is seen where a warp has put things. One file per column of
//! the table of cells. Contents read placements and nothing else.

mod colours;
mod field;
mod scan;
mod solid;

pub use colours::{ColourMix, ColourMixError, Layer, PicturePair, Raster};
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
    /// Two pictures, cross-dissolved.
    Colours,
}

impl ContentKind {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 3] = [Self::Solid, Self::Field, Self::Colours];
}

/// A column of the table with its data.
#[derive(Clone, Debug)]
pub enum Content {
    /// Regions and bars, filled.
    Solid(Solid),
    /// The contour of two blended distance fields.
    Field(FieldPair),
    /// Two pictures, cross-dissolved.
    Colours(PicturePair),
}
