//! Contents: what is seen where a warp has put things. One file per column of
//! the table of cells. Contents read placements and nothing else.

mod coating;
mod colours;
mod field;
mod hole;
mod scan;
mod solid;
mod swell;

pub use coating::{Anchored, Coat, Coating, Shading};
pub use colours::{ColourMix, ColourMixError, Layer, PicturePair, Raster};
pub use field::{BlendSpace, FieldBlend, FieldPair, FieldPairError};
pub use hole::Hole;
pub use solid::{Clocks, Inked, InkedBars, Solid, Speck};
pub use swell::Swell;
pub(crate) use swell::middle;

use crate::names::named;

/// Which content: a column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ContentKind {
    /// Regions and bars, filled.
    Solid,
    /// The contour of two blended distance fields.
    Field,
    /// Two pictures, cross-dissolved.
    Colours,
}

named! { ContentKind {
    Solid: "solid", "Solid", "Regions and bars, filled";
    Field: "field", "Field", "The contour of two blended distance fields";
    Colours: "colours", "Colours", "Two pictures, cross-dissolved";
} }

/// A column of the table with its data.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Content {
    /// Regions and bars, filled.
    Solid(Solid),
    /// The contour of two blended distance fields.
    Field(FieldPair),
    /// Two pictures, cross-dissolved.
    Colours(PicturePair),
}
