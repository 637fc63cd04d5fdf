//! Closed walks that are asked where they cross and what they hold.

use crate::geometry::{Bounds, DVec2, ring_edges, segments_cross, winding};

/// A closed walk and the box around it.
pub(super) struct Outline {
    pub(super) points: Vec<DVec2>,
    bounds: Bounds,
}

impl Outline {
    pub(super) fn of(points: Vec<DVec2>) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self { points, bounds }
    }

    pub(super) fn crosses(&self, other: &Self) -> bool {
        if !self.bounds.meets(&other.bounds) {
            return false;
        }
        ring_edges(&self.points).any(|(a, b)| {
            let edge = Bounds {
                min: a.min(b),
                max: a.max(b),
            };
            edge.meets(&other.bounds)
                && ring_edges(&other.points).any(|(p, q)| segments_cross([a, b], [p, q]))
        })
    }

    pub(super) fn winding(&self, p: DVec2) -> i32 {
        if self.bounds.contains(p) {
            winding(&self.points, p)
        } else {
            0
        }
    }
}
