//! Why two pieces were not triangulated together.

use crate::compatible::validation::CompatibleError;
use crate::geometry::{ApproxPoint, DVec2, Side};
use crate::mesh::triangulation::TriangulationError;
use crate::work::progress::Cancelled;

/// An edge of a boundary ring, named by its first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PieceEdge {
    /// 0 for the outer boundary, 1 for the first hole.
    pub ring: usize,
    /// The edge runs from this point of the ring to the next.
    pub edge: usize,
}

impl std::fmt::Display for PieceEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "edge {} of {}", self.edge + 1, ring_name(self.ring))
    }
}

fn ring_name(ring: usize) -> String {
    match ring {
        0 => "the outline".to_owned(),
        hole => format!("hole {hole}"),
    }
}

/// Why two pieces were not triangulated together. Numbers in messages start
/// at 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PieceMeshError {
    /// No outer boundary.
    #[error("there is no outline; give at least one ring of points")]
    NoOutline,
    /// Different numbers of boundary rings.
    #[error("the source has {} boundary rings and the target {}; close or cut open the holes that have no partner", .0[0], .0[1])]
    Rings([usize; 2]),
    /// Different numbers of points.
    #[error("{} has {} points in the source and {} in the target; match them one to one", ring_name(*ring), points[0], points[1])]
    Counts {
        /// The boundary ring; 0 is the outer one.
        ring: usize,
        /// Its points in source and target.
        points: [usize; 2],
    },
    /// Fewer than three points.
    #[error("{} has {points} points; it needs at least 3", ring_name(*ring))]
    TooFewPoints {
        /// The boundary ring; 0 is the outer one.
        ring: usize,
        /// How many points there are.
        points: usize,
    },
    /// A coordinate is NaN, infinite or out of proportion.
    #[error("point {} of {} in the {side} is not finite or far out; correct its coordinates", vertex + 1, ring_name(*ring))]
    NotFinite {
        /// In which design.
        side: Side,
        /// The boundary ring; 0 is the outer one.
        ring: usize,
        /// The point in its ring.
        vertex: usize,
    },
    /// Two edges touch, or points coincide, other than along a slit.
    #[error("outlines of the {side} touch or cross {}, where they are matched by more points than they were drawn with: keep them further apart there, or choose another method", ApproxPoint(*place))]
    NotSimple {
        /// In which design.
        side: Side,
        /// The edges, of the rings that were given.
        edges: [PieceEdge; 2],
        /// Where the first of them begins.
        place: DVec2,
    },
    /// The outer boundary runs clockwise.
    #[error("the outline of the {0} runs clockwise; reverse its points")]
    Clockwise(Side),
    /// A hole runs counter-clockwise.
    #[error("hole {hole} of the {side} runs counter-clockwise; reverse its points")]
    CounterClockwise {
        /// In which design.
        side: Side,
        /// The hole, the first is 1.
        hole: usize,
    },
    /// A hole is not inside the outline, or inside another hole.
    #[error(
        "a hole of the {0} lies outside its outline or in another hole; make it a part of its own"
    )]
    HoleOutside(Side),
    /// The edge length is no positive number.
    #[error("the edge length {0} is not a positive share of the diameter; use 0.05, say")]
    EdgeLength(f64),
    /// A design's rings were refused, and no fault of theirs was found.
    #[error(
        "the outline of the {side} was not triangulated: {error}; it is finest {}, leave out a point there",
        ApproxPoint(*place)
    )]
    Refused {
        /// Which design.
        side: Side,
        /// Its shortest edge: the likeliest cause.
        shortest: PieceEdge,
        /// Where that begins.
        place: DVec2,
        /// What the triangulation says.
        error: TriangulationError,
    },
    /// No bridge between the outline and a hole runs inside both designs.
    #[error(
        "no cut leads from the outline to a hole in both designs; thicken the walls between them, or leave the hole out"
    )]
    NoBridge,
    /// One design's part of the guaranteed base was not found.
    #[error(
        "the {side} was not triangulated by itself ({error}): it is thinner in a place than its coordinates are exact; thicken its thinnest part, or move the match there"
    )]
    Base {
        /// Which design.
        side: Side,
        /// What the triangulation says.
        error: TriangulationError,
    },
    /// Faces of the guaranteed base that rounding left without area.
    #[error("{} without area in the {side}, {}: the outline is thinner there than its coordinates are exact; thicken it there, or move the match of that place", if *faces == 1 { "a common face is".to_owned() } else { format!("{faces} common faces are") }, ApproxPoint(*place))]
    Folded {
        /// In which design.
        side: Side,
        /// How many.
        faces: usize,
        /// The middle of the first.
        place: DVec2,
    },
    /// The mesh is not valid in the designs' own coordinates.
    #[error(
        "the common triangulation lost its validity in the designs' own coordinates: {0}; or scale both designs to an ordinary size"
    )]
    Mesh(CompatibleError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl PieceMeshError {
    /// The same said of the designs exchanged.
    pub(super) fn swapped(mut self) -> Self {
        if let Self::Base { side, .. } | Self::Folded { side, .. } = &mut self {
            *side = side.other();
        }
        self
    }

    /// The same said of designs so many times as large.
    pub(super) fn enlarged(mut self, by: [f64; 2]) -> Self {
        if let Self::Folded { side, place, .. }
        | Self::NotSimple { side, place, .. }
        | Self::Refused { side, place, .. } = &mut self
        {
            *place *= by[*side];
        }
        self
    }
}
