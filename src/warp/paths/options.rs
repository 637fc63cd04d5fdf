//! Input of the boundary paths: options, ring pairs and their validation.

use crate::geometry::DVec2;
use crate::settings::named;
use serde::{Deserialize, Serialize};

/// Largest absolute value of a coordinate (tolerance: products of four coordinates are finite).
const MAX_COORDINATE: f64 = 1e75;

/// Kind of path on which the vertices move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum VertexPath {
    /// Straight lines, on which rotating shapes shrink.
    Straight,
    /// Paths that result from interpolating the lengths and directions of the edges.
    #[default]
    Intrinsic,
}

named! { VertexPath {
    Straight: "straight", "Straight",
        "Vertices move on straight lines; rotating shapes shrink in between";
    Intrinsic: "intrinsic", "Intrinsic",
        "Edge lengths and directions change evenly; rotating shapes keep their form";
} }

/// Options of the boundary paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PathOptions {
    /// Kind of path on which the vertices move.
    pub course: VertexPath,
}

/// A closed polygon in both designs with corresponding vertices.
///
/// Vertices may coincide. A ring that appears or disappears is a single repeated point in one of
/// the designs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingPair {
    /// Vertices in the source, in order.
    pub source: Vec<DVec2>,
    /// Vertices in the target, as many as in the source and in the same order.
    pub target: Vec<DVec2>,
}

/// Reason why boundary paths cannot be created. Parts and rings are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PathsError {
    /// There are no rings.
    #[error("the match has no outlines; choose designs with filled areas")]
    NoRings,
    /// A ring has no vertices.
    #[error("ring {} of part {} has no points; remove it", ring + 1, part + 1)]
    Empty {
        /// Index of the part.
        part: usize,
        /// Index of the ring in its part.
        ring: usize,
    },
    /// A ring has different numbers of vertices in the two designs.
    #[error("ring {} of part {} has {} points in the source but {} in the target; the numbers must be equal", ring + 1, part + 1, .counts[0], .counts[1])]
    Counts {
        /// Index of the part.
        part: usize,
        /// Index of the ring in its part.
        ring: usize,
        /// Number of vertices in source and target.
        counts: [usize; 2],
    },
    /// A coordinate is NaN, or its absolute value exceeds 1e75.
    #[error("ring {} of part {} has a coordinate that is not finite or larger than {MAX_COORDINATE:e}; correct it", ring + 1, part + 1)]
    OutOfRange {
        /// Index of the part.
        part: usize,
        /// Index of the ring in its part.
        ring: usize,
    },
}

/// Validates the rings of all parts.
///
/// # Errors
/// [`PathsError`] for the first invalid ring.
pub(super) fn check(parts: &[Vec<RingPair>]) -> Result<(), PathsError> {
    if parts.iter().all(Vec::is_empty) {
        return Err(PathsError::NoRings);
    }
    for (part, rings) in parts.iter().enumerate() {
        for (ring, pair) in rings.iter().enumerate() {
            let counts = [pair.source.len(), pair.target.len()];
            if counts[0] != counts[1] {
                return Err(PathsError::Counts { part, ring, counts });
            }
            if counts == [0, 0] {
                return Err(PathsError::Empty { part, ring });
            }
            let points = pair.source.iter().chain(&pair.target);
            let mut coordinates = points.flat_map(|p| p.to_array());
            if !coordinates.all(|x| x.abs() <= MAX_COORDINATE) {
                return Err(PathsError::OutOfRange { part, ring });
            }
        }
    }
    Ok(())
}
