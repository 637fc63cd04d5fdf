//! Composes ink shapes (filled) and paper shapes (white, which erase ink below them) into one area
//! with few Boolean operations. Also wraps the polygon library for unions, differences and
//! intersections.
//!
//! Later shapes cover earlier ones, so each alternation between ink and paper costs a Boolean
//! operation on everything below. Shapes that do not overlap may be reordered, so each shape goes
//! into the lowest layer of its kind that lies above everything of the other kind it might cover.
//! Ten thousand dots, alternately black and white, then form two layers instead of ten thousand.

use super::z_order::ZOrderGrid;
use crate::geometry::{Bounds, DVec2};
use i_overlay::core::fill_rule::FillRule as OverlayFill;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

/// Closed polygons, filled by the non-zero winding rule.
pub(in crate::design) type WindingRings = Vec<Vec<DVec2>>;

/// Shapes sorted into alternating layers: even layers are ink, odd layers are paper (white shapes,
/// which erase the ink below them).
pub(super) struct InkLayers {
    layers: Vec<Vec<WindingRings>>,
    /// For each grid cell of the page, one plus the index of its top layer; 0 if the cell is empty.
    z_order: ZOrderGrid,
}

impl InkLayers {
    /// Creates an empty stack for a page of the given size.
    pub(super) fn of_page(size: DVec2) -> Self {
        Self {
            layers: Vec::new(),
            z_order: ZOrderGrid::of_page(size),
        }
    }

    /// Returns whether no shape has been added.
    pub(super) fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// Adds a shape on top of all earlier shapes.
    pub(super) fn add(&mut self, rings: WindingRings, is_paper: bool) {
        let Some(bounds) = Bounds::of(rings.iter().flatten().copied()) else {
            // A shape without points creates the lowest layer, so that the drawing does not count
            // as empty.
            return self.grow_to(0);
        };
        // The shape goes into the highest layer in its grid cells if that layer is of the same
        // kind, ink or paper; otherwise into the layer above that.
        let top = self.z_order.highest(&bounds).saturating_sub(1);
        let layer = top + usize::from((top % 2 == 1) != is_paper);
        self.z_order.raise(&bounds, layer + 1);
        self.grow_to(layer);
        self.layers[layer].push(rings);
    }

    /// Creates the layer with the given index, and all layers below it, if they do not exist.
    fn grow_to(&mut self, layer: usize) {
        let count = self.layers.len().max(layer + 1);
        self.layers.resize_with(count, Vec::new);
    }

    /// Returns the area of the ink: adds ink layers and subtracts paper layers, from bottom to top.
    pub(super) fn compose(self) -> WindingRings {
        let layers = self.layers.into_iter().map(union).enumerate();
        layers.fold(Vec::new(), |ink, (layer, rings)| match layer % 2 {
            1 => boolean(&ink, &rings, OverlayRule::Difference),
            _ if ink.is_empty() => rings,
            _ => boolean(&ink, &rings, OverlayRule::Union),
        })
    }
}

/// Intersects an area with the area of a clip path, if there is one.
pub(super) fn clip_rings(rings: WindingRings, clip: Option<&WindingRings>) -> WindingRings {
    match clip {
        Some(clip) => boolean(&rings, clip, OverlayRule::Intersect),
        None => rings,
    }
}

/// Maximum number of shapes united in one operation (resource limit: uniting 30,000 overlapping
/// squares at once takes half a minute and gigabytes).
const UNION_BATCH: usize = 8;

/// Returns the union of shapes. Unites small batches separately, which removes their inner edges,
/// and then unites the results.
pub(in crate::design) fn union(mut shapes: Vec<WindingRings>) -> WindingRings {
    while shapes.len() > 1 {
        let unite = |batch: &[WindingRings]| match batch {
            [one] => one.clone(),
            batch => boolean(&batch.concat(), &Vec::new(), OverlayRule::Subject),
        };
        shapes = shapes.chunks(UNION_BATCH).map(unite).collect();
    }
    shapes.pop().unwrap_or_default()
}

/// Returns the area of `rings` that is not covered by `others`.
pub(super) fn difference(rings: &WindingRings, others: &WindingRings) -> WindingRings {
    boolean(rings, others, OverlayRule::Difference)
}

/// Performs a Boolean operation on two areas, both filled by the non-zero rule. Returns no rings if
/// `subject` is empty.
pub(in crate::design) fn boolean(
    subject: &WindingRings,
    clip: &WindingRings,
    rule: OverlayRule,
) -> WindingRings {
    if subject.is_empty() {
        return Vec::new();
    }
    let to_arrays = |rings: &WindingRings| -> Vec<Vec<[f64; 2]>> {
        rings
            .iter()
            .map(|ring| ring.iter().map(|p| p.to_array()).collect())
            .collect()
    };
    to_arrays(subject)
        .overlay_as::<i64>(&to_arrays(clip), rule, OverlayFill::NonZero)
        .into_iter()
        .flatten()
        .map(|ring| ring.into_iter().map(DVec2::from).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{FillRule, Regions};

    fn square(x: f64, y: f64, size: f64) -> WindingRings {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        vec![
            corners
                .map(|(u, v)| DVec2::new(x + size * u, y + size * v))
                .to_vec(),
        ]
    }

    fn area(layers: InkLayers) -> f64 {
        let ink = layers.compose();
        Regions::from_rings(&ink, FillRule::NonZero)
            .expect("ink")
            .area()
    }

    #[test]
    fn later_shapes_cover_earlier_ones() {
        let mut layers = InkLayers::of_page(DVec2::splat(100.0));
        layers.add(square(50.0, 50.0, 10.0), true); // paper below all ink
        layers.add(square(0.0, 0.0, 100.0), false);
        layers.add(square(10.0, 10.0, 40.0), true);
        layers.add(square(20.0, 20.0, 20.0), false);
        layers.add(square(25.0, 25.0, 10.0), true);
        layers.add(square(-50.0, 90.0, 60.0), true);
        assert_eq!(layers.layers.len(), 6);
        let expected = 10_000.0 - 1600.0 + 400.0 - 100.0 - 100.0;
        assert!((area(layers) - expected).abs() < 1e-6);
    }

    #[test]
    fn disjoint_shapes_share_layers_in_any_order() {
        let mut layers = InkLayers::of_page(DVec2::splat(100.0));
        for k in 0..800 {
            let at = |step: i32| f64::from(step % 20) * 5.0;
            let (x, y) = (at(k / 2), at(k / 40));
            let is_paper = k % 2 == 1;
            layers.add(square(x, y, if is_paper { 2.0 } else { 4.0 }), is_paper);
        }
        assert_eq!(layers.layers.len(), 2);
        assert!((area(layers) - 400.0 * 12.0).abs() < 1e-6);
    }
}
