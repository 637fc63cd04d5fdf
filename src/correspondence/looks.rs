//! Appearance of parts: properties other than the shape that influence how parts are paired
//! (paint, height, name and text).

use crate::colour::Paint;
use crate::geometry::Side;

/// Appearance of one part.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PartAppearance {
    /// Index of the paint layer that contains the part; the bottom layer is 0.
    pub(crate) paint_layer: usize,
    /// Height of the part's paint layer among the design's layers: 0 for the bottom layer, 1 for
    /// the top.
    pub(crate) height: f64,
    /// Paint of the part; `None` if the design has no colours.
    pub(crate) paint: Option<Paint>,
    /// Whether the part's paint layer has a line (stroke). A cut through the part would be visible.
    pub(crate) is_lined: bool,
    /// Name of the part in its file; empty if it has none.
    pub(crate) name: String,
    /// Whether the part is a letter of a text.
    pub(crate) is_text: bool,
}

/// Appearance of all parts of both designs. The default is empty: all parts look alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PartAppearances(pub(crate) [Vec<PartAppearance>; 2]);

/// Pairing cost of the largest difference in paint, that between black and white. For comparison, a
/// distance between centres that equals the design's size costs 1 (heuristic).
const PAINT_COST: f64 = 0.5;
/// Pairing cost of the largest difference in height, that between the bottom and the top layer
/// (heuristic).
const HEIGHT_COST: f64 = 0.25;

/// Reduction of the pairing cost for two parts with the same name (heuristic: it exceeds any other
/// single term of the cost in practice).
const NAME_BONUS: f64 = 4.0;

/// Additional pairing cost of a letter with a part that is not a letter, so that letters are paired
/// with letters if possible (heuristic).
const TEXT_COST: f64 = 2.0;

impl PartAppearance {
    /// Returns the cost of pairing two parts. `form` is the cost of their differences in position
    /// and shape.
    pub(in crate::correspondence) fn cost(&self, other: &Self, form: f64) -> f64 {
        let paint = self.paint.zip(other.paint);
        let paint = paint.map_or(0.0, |(a, b)| a.difference(&b));
        let cost = form + PAINT_COST * paint + HEIGHT_COST * (self.height - other.height).abs();
        let cost = cost + TEXT_COST * f64::from(u8::from(self.is_text != other.is_text));
        let is_named = !self.name.is_empty() && self.name == other.name;
        if is_named { cost - NAME_BONUS } else { cost }
    }
}

impl PartAppearances {
    /// Returns whether a part's paint layer has a line (stroke); false if no appearance is given.
    pub(crate) fn is_lined(&self, side: Side, part: usize) -> bool {
        self.0[side].get(part).is_some_and(|look| look.is_lined)
    }

    /// Returns whether a part is a letter of a text; `None` if no appearance is given.
    pub(in crate::correspondence) fn is_text(&self, side: Side, part: usize) -> Option<bool> {
        self.0[side].get(part).map(|look| look.is_text)
    }

    /// Returns the paint layer of a part; 0 if no appearance is given.
    pub(crate) fn paint_layer(&self, side: Side, part: usize) -> usize {
        self.0[side].get(part).map_or(0, |look| look.paint_layer)
    }
}
