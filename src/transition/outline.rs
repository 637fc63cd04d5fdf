//! Closed walks that are asked where they cross and what they hold.

use crate::geometry::{Bounds, DVec2, EdgeBoxes, ring_edges, segments_cross, winding};
use std::sync::OnceLock;

/// A closed walk and the box around it.
pub(super) struct Outline {
    pub(super) points: Vec<DVec2>,
    /// What is on another level is in nobody's way.
    pub(super) level: usize,
    bounds: Bounds,
    /// Its edges, once somebody asks which of them are near.
    edges: OnceLock<EdgeBoxes>,
}

impl Outline {
    pub(super) fn of(points: Vec<DVec2>, level: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self {
            points,
            level,
            bounds,
            edges: OnceLock::new(),
        }
    }

    pub(super) fn crosses(&self, other: &Self) -> bool {
        if self.level != other.level || !self.bounds.meets(&other.bounds) {
            return false;
        }
        let edges = other.edges.get_or_init(|| EdgeBoxes::of(&other.points));
        ring_edges(&self.points).any(|(a, b)| {
            let edge = Bounds {
                min: a.min(b),
                max: a.max(b),
            };
            edges.any_near(&edge, &|other| segments_cross([a, b], other))
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
