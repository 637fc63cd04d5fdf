//! A drawing as the figure that it makes, by a painter who knows two colours,
//! ink and paper.

use super::error::SvgError;
use super::ink_layers::{InkLayers, WindingRings};
use super::painter::PaintedDrawing;
use super::shape::SvgShape;
use crate::colour::{Paint, Rgb};
use crate::geometry::{DVec2, FillRule, Regions};

/// What is ink in the end, with its strokes or without. Shapes of pure white are
/// paper where anything else is painted.
pub(super) fn silhouette(
    painted: &PaintedDrawing,
    page: DVec2,
    strokes: bool,
) -> Result<Regions, SvgError> {
    let shapes = || {
        painted
            .shapes
            .iter()
            .flat_map(|shape| sides(shape, strokes))
    };
    let white_is_paper = shapes().any(|(_, paint)| !is_white(paint));
    let mut layers = InkLayers::of_page(page);
    for (rings, paint) in shapes() {
        layers.lay(rings.clone(), white_is_paper && is_white(paint));
    }
    if layers.is_empty() {
        let strokes = !strokes && painted.bare_strokes > 0;
        return Err(SvgError::NothingFilled { strokes });
    }
    Ok(Regions::from_rings(&layers.composed(), FillRule::NonZero)?)
}

/// The fill of a shape and its stroke, those that are seen and wanted.
fn sides(shape: &SvgShape, strokes: bool) -> impl Iterator<Item = (&WindingRings, &Paint)> {
    let is_read = (strokes || !shape.is_stroke) && shape.paint.opacity > 0.0;
    let fill = is_read.then_some((&shape.rings, &shape.paint));
    let edge = shape.edge.as_ref().filter(|_| strokes);
    fill.into_iter()
        .chain(edge.map(|edge| (&edge.rings, &edge.line.paint)))
}

fn is_white(paint: &Paint) -> bool {
    paint.colour == Rgb([u8::MAX; 3])
}
