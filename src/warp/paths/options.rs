//! What boundary paths are made of, and what may be wrong with it.

use crate::geometry::DVec2;
use crate::settings::choice::named;
use serde::{Deserialize, Serialize};

/// No coordinate is larger: products of a few of them are still numbers.
const FARTHEST: f64 = 1e75;

/// On which paths the vertices move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum VertexPath {
    /// Straight lines: what turns is shortened on the way.
    Straight,
    /// Those that lengths and directions of the edges leave.
    #[default]
    Intrinsic,
}

named! { VertexPath {
    Straight: "straight", "Straight", "On straight lines: what turns shrinks on the way";
    Intrinsic: "intrinsic", "Intrinsic",
        "Edges turn and change their lengths evenly: what turns keeps its form";
} }

/// Options of the boundary paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PathOptions {
    /// On which paths the vertices move.
    pub course: VertexPath,
}

/// A closed polygon in both designs, vertex by vertex. Vertices may coincide:
/// a ring is born from, or dies into, one that is a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingPair {
    /// Vertices in the source, in order.
    pub source: Vec<DVec2>,
    /// As many vertices in the target.
    pub target: Vec<DVec2>,
}

/// Why polygons have no paths. Parts and rings are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PathsError {
    /// There is nothing that could move.
    #[error("the match has no boundaries; give two designs with an area")]
    NoRings,
    /// A ring has no vertices.
    #[error("ring {} of part {} has no points; leave it out", ring + 1, part + 1)]
    Empty {
        /// Which part.
        part: usize,
        /// Which of its rings.
        ring: usize,
    },
    /// A ring's two polygons do not correspond.
    #[error("ring {} of part {} has {} points in the source and {} in the target; they must be as many", ring + 1, part + 1, .counts[0], .counts[1])]
    Counts {
        /// Which part.
        part: usize,
        /// Which of its rings.
        ring: usize,
        /// How many vertices there are in source and target.
        counts: [usize; 2],
    },
    /// A coordinate is NaN, infinite or beyond 1e75.
    #[error("ring {} of part {} has a point that is no number up to {FARTHEST:e}; correct its coordinates", ring + 1, part + 1)]
    OutOfRange {
        /// Which part.
        part: usize,
        /// Which of its rings.
        ring: usize,
    },
}

/// # Errors
/// [`PathsError`] names the first ring that has no paths.
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
            if !coordinates.all(|x| x.abs() <= FARTHEST) {
                return Err(PathsError::OutOfRange { part, ring });
            }
        }
    }
    Ok(())
}
