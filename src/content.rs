//! Contents: what is seen where a warp has put things. One file per column of
//! the table of cells. Contents read placements and nothing else.

mod colours;
mod field;
mod field_content;
mod paint_stack;
mod placement_scan;
mod solid;
mod swelling;
mod transient_hole;

pub use colours::{
    ColourMix, ColourMixError, PictureLayer, PicturePair, PictureRaster, PictureSet,
};
pub use field::{BlendSpace, FieldBlend, FieldPair, FieldPairError, FieldSet};
pub use field_content::{FieldContent, PaintedFields};
pub use paint_stack::{
    AnchoredGradient, InkedLayer, LayerShading, PaintLayerStack, PlacedPaintLayer,
};
pub use solid::{BarClocks, InkedBars, SeedShape, SolidContent};
pub use swelling::SwellingShape;
pub(crate) use swelling::middle;
pub use transient_hole::TransientHole;

use crate::settings::choice::named;
use crate::warp::Placement;

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
    Solid(SolidContent),
    /// The contours of blended distance fields.
    Field(FieldContent),
    /// Two pictures, cross-dissolved.
    Colours(PicturePair),
}

impl Content {
    /// How it is painted; none where it has one colour, or is pictures.
    #[must_use]
    pub fn coating(&self) -> Option<&PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.coating.as_ref(),
            Self::Field(fields) => fields.painted().map(|painted| &painted.coating),
            Self::Colours(_) => None,
        }
    }

    pub(crate) fn coating_mut(&mut self) -> Option<&mut PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.coating.as_mut(),
            Self::Field(fields) => fields.painted_mut().map(|painted| &mut painted.coating),
            Self::Colours(_) => None,
        }
    }

    /// Its rings at `t`, when the placement is that of `t`: coat by coat as they lie
    /// there, the lowest first, or all together where it has one colour. Of pictures
    /// none.
    ///
    /// # Panics
    /// Where a vertex has no place.
    #[must_use]
    pub fn coated_at(&self, placement: &Placement, t: f64) -> Vec<InkedLayer> {
        match self {
            Self::Solid(solid) => solid.coated_at(&placement.in_frame, t),
            Self::Field(fields) => fields.coated_at(placement, t),
            Self::Colours(_) => Vec::new(),
        }
    }
}
