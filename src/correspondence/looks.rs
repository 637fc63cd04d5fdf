//! How the parts of two designs look, besides their form.

use crate::colour::Paint;
use crate::geometry::Side;

/// How a part is painted.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PartLook {
    /// The coat that it is in, from the lowest, 0.
    pub(crate) coat: usize,
    /// How high that is among the design's coats, in [0, 1].
    pub(crate) height: f64,
    /// None where the design has no colour of its own.
    pub(crate) paint: Option<Paint>,
    /// Whether a line runs along it, which a cut would be seen by.
    pub(crate) is_lined: bool,
    /// What somebody calls it; or empty.
    pub(crate) name: String,
    /// Whether it is a letter of a text.
    pub(crate) is_text: bool,
}

/// The looks of all parts of both designs; without any, all look alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PartLooks(pub(crate) [Vec<PartLook>; 2]);

/// What two parts cost to be paired for being unlike in paint, from black to
/// white, and in height, from the lowest coat to the highest: as far apart in
/// place as half the design, and a quarter.
const PAINT: f64 = 0.5;
const HEIGHT: f64 = 0.25;

/// By how much less two parts cost to be paired that have one name: more than any
/// place, form and paint.
const NAMED: f64 = 4.0;

/// By how much more a letter and something else cost to be paired: letters become
/// letters where there are any.
const TEXT: f64 = 2.0;

impl PartLook {
    /// What it costs to pair two parts whose forms and places cost so much.
    pub(in crate::correspondence) fn cost(&self, other: &Self, form: f64) -> f64 {
        let paint = self.paint.zip(other.paint);
        let paint = paint.map_or(0.0, |(a, b)| a.unlike(&b));
        let cost = form + PAINT * paint + HEIGHT * (self.height - other.height).abs();
        let cost = cost + TEXT * f64::from(u8::from(self.is_text != other.is_text));
        let is_named = !self.name.is_empty() && self.name == other.name;
        if is_named { cost - NAMED } else { cost }
    }
}

impl PartLooks {
    /// Whether a line runs along a part.
    pub(crate) fn is_lined(&self, side: Side, part: usize) -> bool {
        self.0[side].get(part).is_some_and(|look| look.is_lined)
    }

    /// Whether a part is a letter of a text; none where all look alike.
    pub(in crate::correspondence) fn is_text(&self, side: Side, part: usize) -> Option<bool> {
        self.0[side].get(part).map(|look| look.is_text)
    }

    /// The coat of a part, 0 where all look alike.
    pub(crate) fn coat(&self, side: Side, part: usize) -> usize {
        self.0[side].get(part).map_or(0, |look| look.coat)
    }
}
