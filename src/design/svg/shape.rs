//! [`SvgShape`]: one painted area of a drawing.

use super::ink_layers::WindingRings;
use super::stroke::ShapeStroke;
use crate::colour::{Gradient, Paint};
use crate::geometry::{Bounds, DVec2};

/// Area of one fill or of one stroke; or a fill together with the stroke along its outline.
pub(super) struct SvgShape {
    /// Area, filled by the non-zero rule.
    pub rings: WindingRings,
    /// Colour and opacity of the area.
    pub paint: Paint,
    /// Gradient of the area, if any, in page coordinates, y up; `paint` is then its mean.
    pub gradient: Option<Gradient>,
    /// Whether the area is that of a stroke.
    pub is_stroke: bool,
    /// Whether the shape belongs to a text element.
    pub is_text: bool,
    /// Stroke along `rings`, if it is attached to this shape instead of being a shape itself.
    pub stroke: Option<ShapeStroke>,
    /// Name of the SVG element or of the innermost named group around it; empty if there is none.
    pub name: String,
}

impl SvgShape {
    /// Creates a rectangle without a name.
    pub(super) fn rectangle(bounds: Bounds, paint: Paint) -> Self {
        let Bounds { min, max } = bounds;
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        Self {
            rings: vec![corners.to_vec()],
            paint,
            gradient: None,
            is_stroke: false,
            is_text: false,
            stroke: None,
            name: String::new(),
        }
    }

    /// Returns the bounding box including the stroke, or `None` if there are no points.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let edge = self.stroke.iter().flat_map(|edge| &edge.rings);
        Bounds::of(self.rings.iter().chain(edge).flatten().copied())
    }

    /// Returns the number of points of `rings`, without those of an attached stroke.
    pub(super) fn points(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }

    /// Splits the shape into its fill, if visible, and its attached stroke, if any, the lower
    /// first.
    pub(super) fn split_stroke(mut self) -> impl Iterator<Item = Self> {
        let edge = self.stroke.take();
        let is_stroke_below = edge.as_ref().is_some_and(|edge| edge.line.is_below_fill);
        let stroke = edge.map(|edge| Self {
            rings: edge.rings,
            paint: edge.line.paint,
            gradient: None,
            is_stroke: true,
            is_text: self.is_text,
            stroke: None,
            name: self.name.clone(),
        });
        let fill = (self.paint.opacity > 0.0).then_some(self);
        in_drawing_order(fill, stroke, is_stroke_below)
    }
}

/// Arranges what is made of the fill and of the stroke of a shape, the lower first.
pub(super) fn in_drawing_order<T>(
    fill: Option<T>,
    stroke: Option<T>,
    is_stroke_below: bool,
) -> impl Iterator<Item = T> {
    let [lower, upper] = if is_stroke_below {
        [stroke, fill]
    } else {
        [fill, stroke]
    };
    lower.into_iter().chain(upper)
}
