//! Closed outlines on paint layers, for crossing and containment tests.

use crate::geometry::{Bounds, DVec2, EdgeBvh, ring_edges, segments_cross, winding};
use std::collections::BTreeMap;

/// A closed outline with its bounding box.
pub(in crate::transition) struct LayeredOutline {
    pub(in crate::transition) points: Vec<DVec2>,
    /// Index of the paint layer; only outlines on the same layer collide.
    pub(in crate::transition) layer: usize,
    bounds: Bounds,
}

impl LayeredOutline {
    /// Wraps a closed polygon.
    pub(in crate::transition) fn of(points: Vec<DVec2>, layer: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self {
            points,
            layer,
            bounds,
        }
    }

    /// Returns whether an edge of this outline crosses another one of its edges.
    pub(in crate::transition) fn crosses_itself(&self) -> bool {
        self.crosses_edges(&EdgeBvh::of(&self.points))
    }

    fn crosses_edges(&self, edges: &EdgeBvh) -> bool {
        ring_edges(&self.points).any(|(a, b)| {
            let edge = Bounds {
                min: a.min(b),
                max: a.max(b),
            };
            edges.any_edge_near(&edge, &|other| segments_cross([a, b], other))
        })
    }

    /// Returns the winding number of the outline about a point.
    pub(in crate::transition) fn winding(&self, p: DVec2) -> i32 {
        if self.bounds.contains(p) {
            winding(&self.points, p)
        } else {
            0
        }
    }
}

/// The edges of many outlines on each paint layer, for crossing tests.
///
/// Outlines can be added one after the other: each layer has search structures of different sizes,
/// and two of similar size are joined (J. L. Bentley and J. B. Saxe, "Decomposable searching
/// problems I", 1980). A test searches as many structures as the logarithm of the number of edges.
#[derive(Default)]
pub(in crate::transition) struct LayeredEdges(BTreeMap<usize, Vec<EdgeBvh>>);

impl LayeredEdges {
    /// Collects the edges of the outlines.
    pub(in crate::transition) fn of<'a>(
        outlines: impl IntoIterator<Item = &'a LayeredOutline>,
    ) -> Self {
        let mut edges: BTreeMap<usize, Vec<(DVec2, DVec2)>> = BTreeMap::new();
        for outline in outlines {
            let layer = edges.entry(outline.layer).or_default();
            layer.extend(ring_edges(&outline.points));
        }
        let hierarchies = edges.into_iter();
        Self(
            hierarchies
                .map(|(layer, edges)| (layer, vec![EdgeBvh::of_edges(edges)]))
                .collect(),
        )
    }

    /// Adds the edges of an outline.
    pub(in crate::transition) fn add(&mut self, outline: &LayeredOutline) {
        let layer = self.0.entry(outline.layer).or_default();
        let mut edges: Vec<_> = ring_edges(&outline.points).collect();
        while let Some(last) = layer.pop_if(|last| last.edges().len() < 2 * edges.len()) {
            edges.extend(last.edges());
        }
        layer.push(EdgeBvh::of_edges(edges));
    }

    /// Returns whether an edge of `outline` crosses one of these edges on the same layer.
    pub(in crate::transition) fn are_crossed_by(&self, outline: &LayeredOutline) -> bool {
        let layer = self.0.get(&outline.layer);
        layer.is_some_and(|layer| layer.iter().any(|edges| outline.crosses_edges(edges)))
    }

    /// Returns the sum of the winding numbers of the outlines on a layer about a point.
    pub(in crate::transition) fn winding(&self, layer: usize, p: DVec2) -> i32 {
        let layer = self.0.get(&layer);
        layer.map_or(0, |layer| layer.iter().map(|edges| edges.winding(p)).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn edges_added_one_by_one_or_together_are_crossed_by_the_same_outlines(
            corners in prop::collection::vec((0usize..2, (-1.0f64..1.0, -1.0f64..1.0)), 2..40),
        ) {
            let square = |&(layer, centre): &(usize, (f64, f64))| {
                let centre = DVec2::from(centre);
                let corner = |turn: u32| {
                    centre + 0.2 * DVec2::from_angle(std::f64::consts::FRAC_PI_2 * f64::from(turn))
                };
                LayeredOutline::of((0..4).map(corner).collect(), layer)
            };
            let mut outlines: Vec<LayeredOutline> = corners.iter().map(square).collect();
            let probe = outlines.pop().expect("two or more");
            let mut added = LayeredEdges::default();
            outlines.iter().for_each(|outline| added.add(outline));
            let crossed = outlines.iter().filter(|other| other.layer == probe.layer).any(|other| {
                ring_edges(&probe.points).any(|(a, b)| {
                    ring_edges(&other.points).any(|(c, d)| segments_cross([a, b], [c, d]))
                })
            });
            prop_assert_eq!(added.are_crossed_by(&probe), crossed);
            prop_assert_eq!(LayeredEdges::of(&outlines).are_crossed_by(&probe), crossed);
        }
    }
}
