//! Closed outlines on paint layers, for crossing and containment tests.

use crate::geometry::{Bounds, DVec2, EdgeBvh, ring_edges, segments_cross, winding};
use std::sync::OnceLock;

/// A closed outline with its bounding box.
pub(in crate::transition) struct LayeredOutline {
    pub(in crate::transition) points: Vec<DVec2>,
    /// Index of the paint layer; only outlines on the same layer collide.
    pub(in crate::transition) layer: usize,
    bounds: Bounds,
    /// Edges in a search structure, built on first use.
    edges: OnceLock<EdgeBvh>,
}

impl LayeredOutline {
    /// Wraps a closed polygon.
    pub(in crate::transition) fn of(points: Vec<DVec2>, level: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self {
            points,
            layer: level,
            bounds,
            edges: OnceLock::new(),
        }
    }

    /// Returns whether an edge of this outline crosses an edge of `other`; `false` if the two are
    /// on different layers.
    pub(in crate::transition) fn crosses(&self, other: &Self) -> bool {
        if self.layer != other.layer || !self.bounds.meets(&other.bounds) {
            return false;
        }
        let edges = other.edges.get_or_init(|| EdgeBvh::of(&other.points));
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
