//! Ink and paper in as few layers as their order asks for.
//!
//! What is painted later hides what lies under it, and each change of colour
//! costs a Boolean operation on all that is there so far. Shapes that do not
//! overlap may change places: each goes into the lowest layer that is above
//! all it might hide, so that a page of ten thousand dots, black and white in
//! turns, is two layers and not ten thousand.

use super::z_order::ZOrderGrid;
use crate::geometry::{Bounds, DVec2};
use i_overlay::core::fill_rule::FillRule as OverlayFill;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

/// Polygons to be filled by winding.
pub(super) type WindingRings = Vec<Vec<DVec2>>;

/// Shapes by the layer they are in: ink in the even ones, paper in the odd.
pub(super) struct InkLayers {
    layers: Vec<Vec<WindingRings>>,
    /// One more than the highest layer.
    heights: ZOrderGrid,
}

impl InkLayers {
    pub(super) fn of_page(size: DVec2) -> Self {
        Self {
            layers: Vec::new(),
            heights: ZOrderGrid::of_page(size),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// Lays a shape over all that is there.
    pub(super) fn lay(&mut self, rings: WindingRings, is_paper: bool) {
        let Some(bounds) = Bounds::of(rings.iter().flatten().copied()) else {
            // A filled line: there is a layer, and nothing is in it.
            return self.reach(0);
        };
        // Beside what is of its colour, or above what is not.
        let top = self.heights.highest(&bounds).saturating_sub(1);
        let layer = top + usize::from((top % 2 == 1) != is_paper);
        self.heights.raise(&bounds, layer + 1);
        self.reach(layer);
        self.layers[layer].push(rings);
    }

    fn reach(&mut self, layer: usize) {
        let count = self.layers.len().max(layer + 1);
        self.layers.resize_with(count, Vec::new);
    }

    /// Ink is added, paper taken away, from the lowest layer up.
    pub(super) fn composed(self) -> WindingRings {
        let layers = self.layers.into_iter().map(union).enumerate();
        layers.fold(Vec::new(), |ink, (layer, rings)| match layer % 2 {
            1 => overlaid(&ink, &rings, OverlayRule::Difference),
            _ if ink.is_empty() => rings,
            _ => overlaid(&ink, &rings, OverlayRule::Union),
        })
    }
}

/// What a clip path lets through, if there is one.
pub(super) fn clipped(rings: WindingRings, clip: Option<&WindingRings>) -> WindingRings {
    match clip {
        Some(clip) => overlaid(&rings, clip, OverlayRule::Intersect),
        None => rings,
    }
}

/// How many shapes are united at once. Of 30,000 squares that overlap all over a
/// page each crosses a thousand others: all at once that took 28 s and gigabytes.
const UNITED: usize = 8;

/// What lies in any of the shapes: few are united at once, so that what lies within
/// others is gone before it meets the rest.
pub(super) fn union(mut shapes: Vec<WindingRings>) -> WindingRings {
    while shapes.len() > 1 {
        let united = |few: &[WindingRings]| match few {
            [one] => one.clone(),
            few => overlaid(&few.concat(), &Vec::new(), OverlayRule::Subject),
        };
        shapes = shapes.chunks(UNITED).map(united).collect();
    }
    shapes.pop().unwrap_or_default()
}

/// What is left of rings where others are taken away.
pub(super) fn difference(rings: &WindingRings, others: &WindingRings) -> WindingRings {
    overlaid(rings, others, OverlayRule::Difference)
}

/// A Boolean operation on areas filled by winding.
fn overlaid(subject: &WindingRings, clip: &WindingRings, rule: OverlayRule) -> WindingRings {
    if subject.is_empty() {
        return Vec::new();
    }
    let plain = |rings: &WindingRings| -> Vec<Vec<[f64; 2]>> {
        rings
            .iter()
            .map(|ring| ring.iter().map(|p| p.to_array()).collect())
            .collect()
    };
    plain(subject)
        .overlay_as::<i64>(&plain(clip), rule, OverlayFill::NonZero)
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
        let ink = layers.composed();
        Regions::from_rings(&ink, FillRule::NonZero)
            .expect("ink")
            .area()
    }

    #[test]
    fn what_is_later_hides_what_it_overlaps() {
        let mut layers = InkLayers::of_page(DVec2::splat(100.0));
        layers.lay(square(50.0, 50.0, 10.0), true); // on nothing
        layers.lay(square(0.0, 0.0, 100.0), false);
        layers.lay(square(10.0, 10.0, 40.0), true);
        layers.lay(square(20.0, 20.0, 20.0), false);
        layers.lay(square(25.0, 25.0, 10.0), true);
        layers.lay(square(-50.0, 90.0, 60.0), true);
        assert_eq!(layers.layers.len(), 6);
        let expected = 10_000.0 - 1600.0 + 400.0 - 100.0 - 100.0;
        assert!((area(layers) - expected).abs() < 1e-6);
    }

    #[test]
    fn shapes_apart_share_their_layers_whatever_their_order() {
        let mut layers = InkLayers::of_page(DVec2::splat(100.0));
        for k in 0..800 {
            let at = |step: i32| f64::from(step % 20) * 5.0;
            let (x, y) = (at(k / 2), at(k / 40));
            let is_paper = k % 2 == 1;
            layers.lay(square(x, y, if is_paper { 2.0 } else { 4.0 }), is_paper);
        }
        assert_eq!(layers.layers.len(), 2);
        assert!((area(layers) - 400.0 * 12.0).abs() < 1e-6);
    }
}
