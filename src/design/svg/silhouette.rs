//! Computes the silhouette of a drawing: paints its shapes in two colours, ink and paper, and
//! returns the area of the ink.

use super::error::SvgError;
use super::ink_layers::{InkLayers, WindingRings};
use super::painter::PaintedDrawing;
use super::shape::{SvgShape, in_drawing_order};
use crate::colour::{Paint, Rgb};
use crate::geometry::{DVec2, FillRule, Regions};

/// Returns the area that is ink after all shapes are painted; strokes are painted if `strokes` is
/// true.
///
/// Pure white shapes are painted as paper and all others as ink. If all shapes are white, all are
/// ink.
pub(super) fn silhouette(
    painted: &PaintedDrawing,
    page: DVec2,
    strokes: bool,
) -> Result<Regions, SvgError> {
    let shapes = || {
        painted
            .shapes
            .iter()
            .flat_map(|shape| visible_areas(shape, strokes))
    };
    let white_is_paper = shapes().any(|(_, paint)| !is_white(paint));
    let mut layers = InkLayers::of_page(page);
    for (rings, paint) in shapes() {
        layers.add(rings.clone(), white_is_paper && is_white(paint));
    }
    if layers.is_empty() {
        let strokes = !strokes && painted.bare_strokes > 0;
        return Err(SvgError::NothingFilled { strokes });
    }
    Ok(Regions::from_rings(&layers.compose(), FillRule::NonZero)?)
}

/// Returns the painted areas of a shape, each with its paint, the lower first: that of the shape
/// itself (a fill or a stroke) and the stroke attached to it, if there is one. Strokes are omitted
/// if `strokes` is false; the area of the shape is also omitted if its opacity is 0.
fn visible_areas(shape: &SvgShape, strokes: bool) -> impl Iterator<Item = (&WindingRings, &Paint)> {
    let is_visible = (strokes || !shape.is_stroke) && shape.paint.opacity > 0.0;
    let fill = is_visible.then_some((&shape.rings, &shape.paint));
    let edge = shape.stroke.as_ref().filter(|_| strokes);
    let stroke = edge.map(|edge| (&edge.rings, &edge.line.paint));
    in_drawing_order(
        fill,
        stroke,
        edge.is_some_and(|edge| edge.line.is_below_fill),
    )
}

fn is_white(paint: &Paint) -> bool {
    paint.colour == Rgb([u8::MAX; 3])
}
