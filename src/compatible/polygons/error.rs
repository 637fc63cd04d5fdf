//! Errors of the compatible triangulation of one piece (a matched connected part).

use super::options::MIN_EDGE_LENGTH;
use crate::compatible::validation::CompatibleError;
use crate::geometry::{ApproxPoint, DVec2, Side};
use crate::mesh::triangulation::TriangulationError;
use crate::work::progress::Cancelled;

/// Edge of a boundary ring, identified by its first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PieceEdge {
    /// Index of the boundary ring: 0 for the outer boundary, 1 for the first hole.
    pub ring: usize,
    /// Index of the edge in its ring: edge i runs from point i to the next point.
    pub edge: usize,
}

impl std::fmt::Display for PieceEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "edge {} of {}", self.edge + 1, ring_name(self.ring))
    }
}

/// Formats the index of a ring as "the outline" for 0 or "hole 1" for 1.
fn ring_name(ring: usize) -> String {
    match ring {
        0 => "the outline".to_owned(),
        hole => format!("hole {hole}"),
    }
}

/// Reason why a piece has no compatible triangulation in two designs. Indices start at 0 in fields
/// unless stated otherwise, and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PieceMeshError {
    /// No boundary ring is given.
    #[error("there is no outline; give at least one ring of points")]
    NoOutline,
    /// Source and target have different numbers of boundary rings. The field contains both numbers.
    #[error("the source has {} boundary rings and the target {}; close or cut open the unmatched holes", .0[0], .0[1])]
    RingCounts([usize; 2]),
    /// A ring has different numbers of points in the two designs.
    #[error("{} has {} points in the source and {} in the target; match them one to one", ring_name(*ring), points[0], points[1])]
    PointCounts {
        /// Index of the boundary ring; 0 is the outer one.
        ring: usize,
        /// Numbers of points of the ring in source and target.
        points: [usize; 2],
    },
    /// A ring has fewer than three points in both designs.
    #[error("{} has {points} points; it needs at least 3", ring_name(*ring))]
    TooFewPoints {
        /// Index of the boundary ring; 0 is the outer one.
        ring: usize,
        /// Number of points of the ring.
        points: usize,
    },
    /// A point has a coordinate that is NaN, infinite, or out of the triangulation's range.
    #[error("point {} of {} in the {side} has a coordinate that is not finite or too large; correct it", vertex + 1, ring_name(*ring))]
    NotFinite {
        /// Design that contains the point.
        side: Side,
        /// Index of the point's boundary ring; 0 is the outer one.
        ring: usize,
        /// Index of the point in its ring.
        vertex: usize,
    },
    /// In one design two boundary edges touch or cross, or two points coincide. Only the two banks
    /// of a slit may do so.
    #[error("outlines of the {side} touch or cross {}; move them apart there, or choose another method", ApproxPoint(*place))]
    NotSimple {
        /// Design in which the edges touch or cross.
        side: Side,
        /// The two edges, numbered in the rings that the caller passed.
        edges: [PieceEdge; 2],
        /// Position at which the first of the two edges starts.
        place: DVec2,
    },
    /// The outer boundary of this design runs clockwise.
    #[error("the outline of the {0} runs clockwise; reverse its points")]
    Clockwise(Side),
    /// A hole of one design runs counter-clockwise.
    #[error("hole {hole} of the {side} runs counter-clockwise; reverse its points")]
    CounterClockwise {
        /// Design that contains the hole.
        side: Side,
        /// Number of the hole, counted from 1.
        hole: usize,
    },
    /// A hole of this design lies outside the outer boundary or inside another hole.
    #[error(
        "a hole of the {0} lies outside its outline or in another hole; make it a separate part"
    )]
    HoleOutside(Side),
    /// The option [`edge_length`](super::PolygonOptions::edge_length) is too small or not a number.
    /// The field is its value.
    #[error(
        "the edge length {0:?} is below {MIN_EDGE_LENGTH} of the diameter; use 0.05, for example"
    )]
    EdgeLength(f64),
    /// The rings of one design cannot be triangulated, and no specific fault was found in them.
    #[error(
        "the outline of the {side} cannot be triangulated: {error}; its shortest edge is {}, remove a point there",
        ApproxPoint(*place)
    )]
    NotTriangulated {
        /// Design whose rings cannot be triangulated.
        side: Side,
        /// Shortest boundary edge of that design, which is the likeliest cause.
        shortest: PieceEdge,
        /// Position at which the shortest edge starts.
        place: DVec2,
        /// Error that the triangulation returned.
        error: TriangulationError,
    },
    /// No bridge from the outer boundary to a hole lies inside the piece in both designs.
    #[error(
        "no cut from the outline to a hole is possible in both designs; thicken the walls between them, or leave the hole out"
    )]
    NoBridge,
    /// In one design, a polygon could not be triangulated while the base mesh was built, which is
    /// done if simpler methods fail.
    #[error(
        "the {side} cannot be triangulated ({error}): part of it is thinner than floating-point precision; thicken its thinnest part, or move the match there"
    )]
    Base {
        /// Design in which the triangulation failed.
        side: Side,
        /// Error that the triangulation returned.
        error: TriangulationError,
    },
    /// Because of rounding, faces of the base mesh, which is built if simpler methods fail, are
    /// flat or folded in one design.
    #[error("{} without area in the {side}, {}: the outline is thinner there than floating-point precision; thicken it, or move the match there", if *faces == 1 { "a common face is".to_owned() } else { format!("{faces} common faces are") }, ApproxPoint(*place))]
    Folded {
        /// Design in which the faces are flat or folded.
        side: Side,
        /// Number of faces that are flat or folded.
        faces: usize,
        /// Centroid of the first flat or folded face.
        place: DVec2,
    },
    /// The mesh is valid in the scaled coordinates in which it was computed, but rounding to the
    /// designs' own coordinates made it invalid.
    #[error(
        "the common triangulation is not valid in the designs' own coordinates: {0}; or scale both designs to a moderate size"
    )]
    Mesh(CompatibleError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl PieceMeshError {
    /// Returns the same error with source and target exchanged.
    pub(super) fn swapped(mut self) -> Self {
        if let Self::Base { side, .. } | Self::Folded { side, .. } = &mut self {
            *side = side.other();
        }
        self
    }

    /// Returns the same error for designs whose coordinates are multiplied by `by`, one factor for
    /// each design.
    pub(super) fn scaled(mut self, by: [f64; 2]) -> Self {
        if let Self::Folded { side, place, .. }
        | Self::NotSimple { side, place, .. }
        | Self::NotTriangulated { side, place, .. } = &mut self
        {
            *place *= by[*side];
        }
        self
    }
}
