//! What is painted at once.

use super::ink_layers::WindingRings;
use super::stroke::ShapeStroke;
use crate::colour::{Gradient, Paint};
use crate::geometry::Bounds;

/// What one fill or one stroke covers, or a fill with the stroke along it.
pub(super) struct SvgShape {
    /// To be filled by winding.
    pub rings: WindingRings,
    pub paint: Paint,
    /// On the page, y up; the paint is its mean.
    pub gradient: Option<Gradient>,
    pub is_stroke: bool,
    pub is_text: bool,
    /// The stroke along the rings, if it goes with them.
    pub edge: Option<ShapeStroke>,
    /// The id of its element, if it has one.
    pub name: String,
}

impl SvgShape {
    /// The box around all that it covers.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let edge = self.edge.iter().flat_map(|edge| &edge.rings);
        Bounds::of(self.rings.iter().chain(edge).flatten().copied())
    }

    /// How many points it has.
    pub(super) fn points(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }

    /// Its fill and its stroke, each for itself, if it is seen.
    pub(super) fn apart(mut self) -> impl Iterator<Item = Self> {
        let (edge, fill) = (self.edge.take(), self);
        let stroke = edge.map(|edge| Self {
            rings: edge.rings,
            paint: edge.line.paint,
            gradient: None,
            is_stroke: true,
            is_text: fill.is_text,
            edge: None,
            name: fill.name.clone(),
        });
        let fill = (fill.paint.opacity > 0.0).then_some(fill);
        fill.into_iter().chain(stroke)
    }
}
