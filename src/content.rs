//! Contents: the drawable data that a warp moves. Each kind is a column of the table of transitions
//! in the crate documentation.
//!
//! There are three kinds: filled regions and bars ([`SolidContent`]), blended distance fields
//! ([`FieldContent`]) and cross-dissolved pictures ([`PicturePair`]). A content reads the positions
//! of vertices from a [`Placement`] and depends on nothing else of the warp.

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

/// Kind of content: a column of the table of transitions in the crate documentation.
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

/// The data that is drawn at each t, by kind.
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
    /// Returns the paint layers; `None` for a content in a single colour and for pictures.
    #[must_use]
    pub fn paint_layers(&self) -> Option<&PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.paint_layers.as_ref(),
            Self::Field(fields) => fields.painted_fields().map(|painted| &painted.paint_layers),
            Self::Colours(_) => None,
        }
    }

    /// Returns mutable access to the paint layers; `None` for a content in a single colour and for
    /// pictures.
    pub(crate) fn paint_layers_mut(&mut self) -> Option<&mut PaintLayerStack> {
        match self {
            Self::Solid(solid) => solid.paint_layers.as_mut(),
            Self::Field(fields) => fields
                .painted_fields_mut()
                .map(|painted| &mut painted.paint_layers),
            Self::Colours(_) => None,
        }
    }

    /// Returns the rings that are drawn at `t`, grouped by paint layer, the lowest layer first. A
    /// content in a single colour has one group; pictures have none.
    ///
    /// `placement` must be the placement of the warp at the same `t`.
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
