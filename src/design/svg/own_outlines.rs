//! Attaches outlines to the fills that they surround. Illustrations often draw a fill and the
//! stroke along its edge as two elements; as one shape, both move together.

use super::ink_layers::{WindingRings, clip_rings, difference};
use super::shape::SvgShape;
use crate::geometry::{Bounds, perimeter, signed_area};
use std::collections::HashMap;

/// Maximum number of corners that go through Boolean operations (resource limit: about a second).
const MAX_POINTS: usize = 2_000_000;

/// Attaches each outline without a fill to the last fill below it that has the same edge, if no
/// shape between the two covers part of the outline. `tolerance` is the maximum deviation of
/// flattened curves, in page units.
pub(super) fn attach_outlines(shapes: &mut Vec<SvgShape>, tolerance: f64) {
    let mut search = OutlineSearch {
        tolerance,
        fills: HashMap::new(),
        points_left: MAX_POINTS,
    };
    let mut is_attached = vec![false; shapes.len()];
    for k in 0..shapes.len() {
        if !is_bare_outline(&shapes[k]) {
            search.add_fill(&shapes[k], k);
        } else if let Some(below) = search.fill_below(shapes, &is_attached, k) {
            let outline = shapes[k].stroke.take();
            let name = std::mem::take(&mut shapes[k].name);
            let fill = &mut shapes[below];
            fill.stroke = outline;
            if fill.name.is_empty() {
                fill.name = name;
            }
            is_attached[k] = true;
        }
    }
    let mut attached = is_attached.into_iter();
    shapes.retain(|_| !attached.next().unwrap_or(false));
}

/// Returns whether a shape has a stroke but no visible fill.
fn is_bare_outline(shape: &SvgShape) -> bool {
    shape.stroke.is_some() && shape.paint.opacity == 0.0
}

/// Search for the fill that an outline surrounds.
struct OutlineSearch {
    tolerance: f64,
    /// Indices of the fills with their boxes, by the grid cell of the lower left corner of the box.
    fills: HashMap<[i64; 2], Vec<(usize, Bounds)>>,
    /// Number of corners that may still go through Boolean operations.
    points_left: usize,
}

impl OutlineSearch {
    /// Returns the grid cell of a box; boxes of equal edges lie in the same or in adjacent cells.
    fn cell(&self, bounds: &Bounds) -> [i64; 2] {
        let cell = bounds.min / (2.0 * self.tolerance).max(f64::MIN_POSITIVE);
        [cell.x, cell.y].map(|coordinate| coordinate.floor() as i64)
    }

    /// Adds a shape that may have an outline, if it is a fill without a stroke.
    fn add_fill(&mut self, shape: &SvgShape, index: usize) {
        let bounds = Bounds::of(shape.rings.iter().flatten().copied());
        if let Some(bounds) = bounds.filter(|_| shape.stroke.is_none() && !shape.is_stroke) {
            let fills = self.fills.entry(self.cell(&bounds)).or_default();
            fills.push((index, bounds));
        }
    }

    /// Returns the index of the fill to which the outline `shapes[k]` is attached.
    fn fill_below(&mut self, shapes: &[SvgShape], is_attached: &[bool], k: usize) -> Option<usize> {
        let outline = &shapes[k];
        let bounds = Bounds::of(outline.rings.iter().flatten().copied())?;
        let below = self
            .candidates(&bounds)
            .into_iter()
            .filter(|&fill| shapes[fill].stroke.is_none())
            .find(|&fill| self.has_edge_of(&shapes[fill], outline))?;
        let between = (below + 1..k).filter(|&shape| !is_attached[shape]);
        let area = &outline.stroke.as_ref()?.rings;
        let mut covering = between.filter(|&shape| self.covers(&shapes[shape], area));
        covering.next().is_none().then_some(below)
    }

    /// Returns the fills whose box is that of an outline, up to the tolerance, the last one first.
    fn candidates(&self, bounds: &Bounds) -> Vec<usize> {
        let [x, y] = self.cell(bounds);
        let cells = (-1..=1)
            .flat_map(|dx| (-1..=1).map(move |dy| [x.saturating_add(dx), y.saturating_add(dy)]));
        let fills = cells.filter_map(|cell| self.fills.get(&cell)).flatten();
        let limit = 2.0 * self.tolerance;
        let is_near = |other: &Bounds| {
            let corners = [bounds.min - other.min, bounds.max - other.max];
            corners
                .iter()
                .all(|shift| shift.abs().max_element() <= limit)
        };
        let near = fills.filter(|(_, other)| is_near(other));
        let mut near: Vec<usize> = near.map(|(fill, _)| *fill).collect();
        near.sort_unstable_by(|a, b| b.cmp(a));
        near
    }

    /// Returns whether two shapes have the same edge: whether their areas differ at most by a band
    /// as wide as two flattened versions of one curve may be apart.
    fn has_edge_of(&mut self, fill: &SvgShape, outline: &SvgShape) -> bool {
        if fill.is_text != outline.is_text || !self.spend(&fill.rings, &outline.rings) {
            return false;
        }
        let differences = [
            difference(&fill.rings, &outline.rings),
            difference(&outline.rings, &fill.rings),
        ];
        let length: f64 = outline.rings.iter().map(|ring| perimeter(ring)).sum();
        differences.iter().map(area).sum::<f64>() <= 2.0 * self.tolerance * length
    }

    /// Returns whether a shape covers part of an area.
    fn covers(&mut self, shape: &SvgShape, rings: &WindingRings) -> bool {
        let boxes = [shape.bounds(), Bounds::of(rings.iter().flatten().copied())];
        let [Some(own), Some(other)] = boxes else {
            return false;
        };
        if !own.meets(&other) {
            return false;
        }
        let stroke = shape.stroke.as_ref().map(|edge| &edge.rings);
        let fill = (shape.paint.opacity > 0.0).then_some(&shape.rings);
        // Without points left, the shape counts as covering, and the outline stays where it is.
        fill.into_iter().chain(stroke).any(|part| {
            !self.spend(part, rings) || !clip_rings(part.clone(), Some(rings)).is_empty()
        })
    }

    /// Counts the corners of a Boolean operation; returns whether the operation is allowed.
    fn spend(&mut self, a: &WindingRings, b: &WindingRings) -> bool {
        let points: usize = a.iter().chain(b).map(Vec::len).sum();
        let is_allowed = points <= self.points_left;
        self.points_left = self.points_left.saturating_sub(points);
        is_allowed
    }
}

/// Returns the area of the result of a Boolean operation.
fn area(rings: &WindingRings) -> f64 {
    rings
        .iter()
        .map(|ring| signed_area(ring))
        .sum::<f64>()
        .abs()
}
