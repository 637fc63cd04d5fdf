//! A drawing as the figure that it makes, by a painter who knows two colours,
//! ink and paper.

use super::error::SvgError;
use super::layers::Layers;
use super::paint::Painted;
use super::shape::Shape;
use crate::geometry::{DVec2, FillRule, Regions};

/// What is ink in the end, with its strokes or without. Shapes of pure white are
/// paper where anything else is painted.
pub(super) fn silhouette(
    painted: &Painted,
    page: DVec2,
    strokes: bool,
) -> Result<Regions, SvgError> {
    let is_read = |shape: &&Shape| strokes || !shape.is_stroke;
    let shapes = || painted.shapes.iter().filter(is_read);
    let white_is_paper = shapes().any(|shape| !shape.is_white());
    let mut layers = Layers::of_page(page);
    for shape in shapes() {
        layers.lay(shape.rings.clone(), white_is_paper && shape.is_white());
    }
    if layers.is_empty() {
        let strokes = !strokes && painted.bare_strokes > 0;
        return Err(SvgError::NothingFilled { strokes });
    }
    Ok(Regions::from_rings(&layers.composed(), FillRule::NonZero)?)
}
