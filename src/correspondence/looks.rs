//! Appearance of parts: properties other than the shape that influence how parts are paired
//! (paint, height, name and text).

use crate::colour::Paint;
use crate::geometry::Side;
use std::collections::HashSet;

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

/// Reduction of the pairing cost for two parts with the same name (derived: all other terms of a
/// pair add up to less than 100, and a design has fewer than 10,000 parts, so no other saving
/// outweighs a pair of equal names; rounding errors of sums this large are below 1e-9).
const NAME_BONUS: f64 = 1e6;

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
        if self.has_name_of(other) {
            cost - NAME_BONUS
        } else {
            cost
        }
    }

    /// Returns whether both parts have the same name.
    fn has_name_of(&self, other: &Self) -> bool {
        !self.name.is_empty() && self.name == other.name
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

    /// Returns the name of a part; empty if it has none or no appearance is given.
    pub(in crate::correspondence) fn name(&self, side: Side, part: usize) -> &str {
        self.0[side].get(part).map_or("", |look| &look.name)
    }

    /// Returns whether two parts have the same name; false if no appearance is given.
    pub(in crate::correspondence) fn are_namesakes(&self, parts: [usize; 2]) -> bool {
        let [source, target] = Side::BOTH.map(|side| self.0[side].get(parts[side]));
        source.is_some_and(|source| target.is_some_and(|target| source.has_name_of(target)))
    }

    /// Returns the names that parts of both designs have.
    pub(crate) fn common_names(&self) -> HashSet<&str> {
        let [source, target] = Side::BOTH.map(|side| -> HashSet<&str> {
            let names = self.0[side].iter().map(|look| look.name.as_str());
            names.filter(|name| !name.is_empty()).collect()
        });
        source.intersection(&target).copied().collect()
    }

    /// If all parts of one design have the same paint, returns the parts of the other design that
    /// do not look like them: those whose paint differs by at least half as much as the paint that
    /// differs most. If one of these parts were matched, its partner would change its colour,
    /// although a part of its own colour exists. Parts with a name that both designs have are not
    /// included.
    ///
    /// Empty if no part of the other design looks like them.
    pub(in crate::correspondence) fn unlike_parts(&self) -> [Vec<usize>; 2] {
        let common_names = self.common_names();
        Side::BOTH.map(|side| {
            let Some(paint) = self.only_paint(side.other()) else {
                return Vec::new();
            };
            let looks = &self.0[side];
            let differences: Vec<f64> = looks
                .iter()
                .map(|look| {
                    look.paint
                        .map_or(f64::INFINITY, |own| own.difference(&paint))
                })
                .collect();
            let largest = differences.iter().copied().fold(0.0, f64::max);
            let is_unlike = |k: &usize| 2.0 * differences[*k] >= largest;
            if (0..looks.len()).all(|k| is_unlike(&k)) {
                return Vec::new();
            }
            let is_common = |k: &usize| common_names.contains(looks[*k].name.as_str());
            (0..looks.len())
                .filter(|k| is_unlike(k) && !is_common(k))
                .collect()
        })
    }

    /// Returns the paint that all parts of a design have; `None` if they differ or have no paint.
    fn only_paint(&self, side: Side) -> Option<Paint> {
        let first = self.0[side].first()?.paint?;
        let is_first = |look: &PartAppearance| look.paint == Some(first);
        self.0[side].iter().all(is_first).then_some(first)
    }

    /// Returns the paint layer of a part; 0 if no appearance is given.
    pub(crate) fn paint_layer(&self, side: Side, part: usize) -> usize {
        self.0[side].get(part).map_or(0, |look| look.paint_layer)
    }
}
