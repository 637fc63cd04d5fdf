//! Closed walks that are asked where they cross and what they hold.

use crate::geometry::{Bounds, DVec2, EdgeBvh, ring_edges, segments_cross, winding};
use std::sync::OnceLock;

/// A closed walk and the box around it.
pub(in crate::transition) struct LayeredOutline {
    pub(in crate::transition) points: Vec<DVec2>,
    /// What is on another level is in nobody's way.
    pub(in crate::transition) level: usize,
    bounds: Bounds,
    /// Its edges, once somebody asks which of them are near.
    edges: OnceLock<EdgeBvh>,
}

impl LayeredOutline {
    pub(in crate::transition) fn of(points: Vec<DVec2>, level: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self {
            points,
            level,
            bounds,
            edges: OnceLock::new(),
        }
    }

    pub(in crate::transition) fn crosses(&self, other: &Self) -> bool {
        if self.level != other.level || !self.bounds.meets(&other.bounds) {
            return false;
        }
        let edges = other.edges.get_or_init(|| EdgeBvh::of(&other.points));
        ring_edges(&self.points).any(|(a, b)| {
            let edge = Bounds {
                min: a.min(b),
                max: a.max(b),
            };
            edges.any_near(&edge, &|other| segments_cross([a, b], other))
        })
    }

    pub(in crate::transition) fn winding(&self, p: DVec2) -> i32 {
        if self.bounds.contains(p) {
            winding(&self.points, p)
        } else {
            0
        }
    }
}
