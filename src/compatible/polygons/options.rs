//! Options of the compatible triangulation.

use serde::{Deserialize, Serialize};

/// Smallest edge length that can be requested, as a fraction of the diameter (resource limit: 2
/// million vertices).
pub(super) const MIN_EDGE_LENGTH: f64 = 1e-3;

/// Options of the compatible triangulation of a piece (a matched connected part).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolygonOptions {
    /// Requested maximum length of inner edges, as a fraction of each design's diameter, at least
    /// 0.001. If `None`,
    /// faces get larger from the boundary inwards, usually with at most two inner vertices for each
    /// boundary vertex.
    pub edge_length: Option<f64>,
}

impl PolygonOptions {
    /// Maximum number of inner vertices that refinement may add to a piece with `boundary` boundary
    /// vertices.
    pub(super) fn max_inner_points(&self, boundary: usize) -> usize {
        match self.edge_length {
            // Typical pairs need 1.1 to 1.8 inner vertices for each boundary vertex.
            None => 2 * boundary,
            // The second term is about twice the need: equilateral triangles of side `share` fill a
            // disc of diameter 1 with 0.9 / share² vertices.
            Some(share) => 2 * boundary + (2.0 / share.max(MIN_EDGE_LENGTH).powi(2)) as usize,
        }
    }
}
