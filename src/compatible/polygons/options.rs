//! How fine the common triangulation of two polygons is to be.

use serde::{Deserialize, Serialize};

/// How two polygons are triangulated together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolygonOptions {
    /// Longest edge wanted inside, as a share of each design's diameter;
    /// without one, faces grow from the boundary inwards, with at most two
    /// inner vertices for each of the boundary in all but hard cases.
    pub edge_length: Option<f64>,
}

impl PolygonOptions {
    /// The most inner vertices that a refinement may make.
    pub(super) fn most_points(&self, boundary: usize) -> usize {
        // Two million points: finer would be taken for a slip of the hand.
        const FINEST: f64 = 1e-3;
        match self.edge_length {
            // 60 public pairs took 1.1 to 1.8 for each of the boundary.
            None => 2 * boundary,
            // A disc of one diameter takes 0.9 / share² at that edge.
            Some(share) => 2 * boundary + (2.0 / share.max(FINEST).powi(2)) as usize,
        }
    }
}
