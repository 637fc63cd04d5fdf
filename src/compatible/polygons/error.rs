//! Errors of the compatible triangulation of one piece.

use crate::compatible::validation::CompatibleError;
use crate::geometry::{ApproxPoint, DVec2, Side};
use crate::mesh::triangulation::TriangulationError;
use crate::work::progress::Cancelled;

/// Edge of a boundary ring, identified by its first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PieceEdge {
    /// Index of the ring: 0 for the outer boundary, 1 for the first hole.
    pub ring: usize,
    /// Index of the edge; it runs from this point of the ring to the next.
    pub edge: usize,
}

impl std::fmt::Display for PieceEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "edge {} of {}", self.edge + 1, ring_name(self.ring))
    }
}

/// "the outline" or "hole 1".
fn ring_name(ring: usize) -> String {
    match ring {
        0 => "the outline".to_owned(),
        hole => format!("hole {hole}"),
    }
}

/// Reason why a piece has no compatible triangulation in two designs. Messages count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PieceMeshError {
    /// There is no outer boundary.
    #[error("there is no outline; give at least one ring of points")]
    NoOutline,
    /// The designs have different numbers of boundary rings.
    #[error("the source has {} boundary rings and the target {}; close or cut open the unmatched holes", .0[0], .0[1])]
    RingCounts([usize; 2]),
    /// A ring has different numbers of points in the two designs.
    #[error("{} has {} points in the source and {} in the target; match them one to one", ring_name(*ring), points[0], points[1])]
    PointCounts {
        /// Boundary ring; 0 is the outer one.
        ring: usize,
        /// Numbers of points in source and target.
        points: [usize; 2],
    },
    /// A ring has fewer than three points.
    #[error("{} has {points} points; it needs at least 3", ring_name(*ring))]
    TooFewPoints {
        /// Boundary ring; 0 is the outer one.
        ring: usize,
        /// Number of its points.
        points: usize,
    },
    /// A coordinate is NaN, infinite, or out of the triangulation's range.
    #[error("point {} of {} in the {side} has a coordinate that is not finite or too large; correct it", vertex + 1, ring_name(*ring))]
    NotFinite {
        /// Design with the point.
        side: Side,
        /// Boundary ring; 0 is the outer one.
        ring: usize,
        /// Index of the point in its ring.
        vertex: usize,
    },
    /// Two edges touch or cross, or points coincide, other than along a slit.
    #[error("outlines of the {side} touch or cross {}; move them apart there, or choose another method", ApproxPoint(*place))]
    NotSimple {
        /// Design with the edges.
        side: Side,
        /// The edges, in the rings as given.
        edges: [PieceEdge; 2],
        /// Start of the first edge.
        place: DVec2,
    },
    /// The outer boundary runs clockwise.
    #[error("the outline of the {0} runs clockwise; reverse its points")]
    Clockwise(Side),
    /// A hole runs counter-clockwise.
    #[error("hole {hole} of the {side} runs counter-clockwise; reverse its points")]
    CounterClockwise {
        /// Design with the hole.
        side: Side,
        /// Number of the hole; the first is 1.
        hole: usize,
    },
    /// A hole lies outside the outline or inside another hole.
    #[error(
        "a hole of the {0} lies outside its outline or in another hole; make it a separate part"
    )]
    HoleOutside(Side),
    /// The edge length is not a positive number.
    #[error(
        "the edge length {0} is not a positive fraction of the diameter; use 0.05, for example"
    )]
    EdgeLength(f64),
    /// A design's rings cannot be triangulated, and no specific fault was found.
    #[error(
        "the outline of the {side} cannot be triangulated: {error}; its shortest edge is {}, remove a point there",
        ApproxPoint(*place)
    )]
    NotTriangulated {
        /// Design with the rings.
        side: Side,
        /// Its shortest edge, the likeliest cause.
        shortest: PieceEdge,
        /// Start of that edge.
        place: DVec2,
        /// Error of the triangulation.
        error: TriangulationError,
    },
    /// No bridge between the outline and a hole lies inside both designs.
    #[error(
        "no cut from the outline to a hole is possible in both designs; thicken the walls between them, or leave the hole out"
    )]
    NoBridge,
    /// One design's part of the guaranteed base could not be triangulated.
    #[error(
        "the {side} cannot be triangulated ({error}): part of it is thinner than floating-point precision; thicken its thinnest part, or move the match there"
    )]
    Base {
        /// Design that failed.
        side: Side,
        /// Error of the triangulation.
        error: TriangulationError,
    },
    /// Rounding left faces of the guaranteed base without area.
    #[error("{} without area in the {side}, {}: the outline is thinner there than floating-point precision; thicken it, or move the match there", if *faces == 1 { "a common face is".to_owned() } else { format!("{faces} common faces are") }, ApproxPoint(*place))]
    Folded {
        /// Design with the faces.
        side: Side,
        /// Number of these faces.
        faces: usize,
        /// Centroid of the first one.
        place: DVec2,
    },
    /// The mesh is not valid in the designs' own coordinates.
    #[error(
        "the common triangulation is not valid in the designs' own coordinates: {0}; or scale both designs to a moderate size"
    )]
    Mesh(CompatibleError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl PieceMeshError {
    /// The error with the designs exchanged.
    pub(super) fn swapped(mut self) -> Self {
        if let Self::Base { side, .. } | Self::Folded { side, .. } = &mut self {
            *side = side.other();
        }
        self
    }

    /// The error with each design's coordinates multiplied by `by`.
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
