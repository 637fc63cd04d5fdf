//! Contents: the drawable data that a warp moves, one kind per column of the table in the crate
//! documentation.
//!
//! There are three: filled regions and bars ([`SolidContent`]), blended distance fields
//! ([`FieldContent`]) and cross-dissolved pictures ([`PicturePair`]). A content reads vertex
//! positions from a [`Placement`] and depends on nothing else of the warp.

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
pub use field::{BlendSpace, FieldBlend, FieldBlendError, FieldPair, FieldSet};
pub use field_content::{FieldContent, PaintedFields};
pub use paint_stack::{
    AnchoredGradient, InkedLayer, LayerShading, PaintLayerStack, PlacedPaintLayer,
};
pub use solid::{InkedBars, SeedShape, SolidClocks, SolidContent};
pub use swelling::SwellingShape;
pub(crate) use swelling::mean_point;
pub use transient_hole::TransientHole;

use crate::settings::named;
use crate::warp::Placement;

/// Kind of content: a column of the table of transitions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ContentKind {
    /// Filled regions and bars.
    Solid,
    /// Contour of blended distance fields.
    Field,
    /// Two cross-dissolved pictures.
    Colours,
}

named! { ContentKind {
    Solid: "solid", "Solid", "Filled regions and bars";
    Field: "field", "Field", "Contour of two blended distance fields";
    Colours: "colours", "Colours", "Two cross-dissolved pictures";
} }

/// Data that is drawn at each t, by kind.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Content {
    /// Filled regions and bars.
    Solid(SolidContent),
    /// Contours of blended distance fields.
    Field(FieldContent),
    /// Two cross-dissolved pictures.
    Colours(PicturePair),
}

impl Content {
    /// Returns the paint layers; `None` for a content in one colour and for pictures.
    #[must_use]
    pub fn paint_layers(&self) -> Option<&PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.paint_layers.as_ref(),
            Self::Field(fields) => fields.painted().map(|painted| &painted.paint_layers),
            Self::Colours(_) => None,
        }
    }

    /// Mutable access to the paint layers; `None` for a content in one colour and for pictures.
    pub(crate) fn paint_layers_mut(&mut self) -> Option<&mut PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.paint_layers.as_mut(),
            Self::Field(fields) => fields
                .painted_mut()
                .map(|painted| &mut painted.paint_layers),
            Self::Colours(_) => None,
        }
    }

    /// Returns the rings at `t`, grouped by paint layer in drawing order, lowest first. A content
    /// in one colour has a single group; pictures have none.
    ///
    /// `placement` must be the placement at the same `t`.
    ///
    /// # Panics
    /// Panics if a ring uses a vertex that `placement` does not have.
    #[must_use]
    pub fn layers_at(&self, placement: &Placement, t: f64) -> Vec<InkedLayer> {
        match self {
            Self::Solid(solid) => solid.layers_at(&placement.in_frame, t),
            Self::Field(fields) => fields.layers_at(placement, t),
            Self::Colours(_) => Vec::new(),
        }
    }
}
