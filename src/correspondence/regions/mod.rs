//! The match of two designs with all their parts and holes.
//!
//! Parts are paired ([`super::pair_parts`]), each pair's outer boundaries and
//! holes are matched, and what one design alone has is given a partner: a
//! hole closes to a point or its ring is cut open, a part is split off the
//! other design's or is born from a point. The outcome is a list of
//! [`PieceMatch`]es, each one connected and with as many rings on either
//! side: what a common triangulation can be made of.
//!
//! Guaranteed: corresponding rings have the same number of vertices; all
//! points of the given outlines are vertices, bit by bit; pins are honoured
//! exactly or refused in words. A point stands for a ring of
//! [`POINT_SIZE`] of the design's diameter.

use crate::geometry::DVec2;

/// Diameter of the tiny ring that a hole closes to, and of the part that is
/// born, as a share of the design's diameter: a pixel on a screen of 4,000.
pub const POINT_SIZE: f64 = 2.5e-4;

/// How all of two designs goes together.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionMatch {
    /// The pieces, in the order of the source's parts; born ones last.
    pub pieces: Vec<PieceMatch>,
}

/// One connected piece in both designs.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceMatch {
    /// The outer ring first, counter-clockwise, then holes, clockwise.
    pub rings: Vec<RingMatch>,
    /// Which of the source's parts it is, or is cut from; none if it is born.
    pub source_part: Option<usize>,
    /// Which of the target's parts it is, or is cut from; none if it dies.
    pub target_part: Option<usize>,
    /// Where rings were cut open: the ends on the outer boundary and on the
    /// hole.
    pub cuts: Vec<super::RingCut>,
    /// The rotation that lays the source's outer ring onto the target's, in
    /// radians in (−π, π].
    pub rotation: f64,
    /// How unlike the outer rings are as matched; see
    /// [`super::BoundaryMatch::cost`].
    pub cost: f64,
}

/// Corresponding vertices of one ring. Vertex k of the source is vertex k of
/// the target.
///
/// A ring that was cut open runs along its cut twice, there and back, through
/// the same points bit by bit.
#[derive(Clone, Debug, PartialEq)]
pub struct RingMatch {
    /// Vertices on the source.
    pub source: Vec<DVec2>,
    /// Vertices on the target.
    pub target: Vec<DVec2>,
    /// What kind of ring it is.
    pub kind: RingKind,
}

/// What becomes of a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RingKind {
    /// It is matched with another.
    Matched,
    /// It closes to a point in the target.
    Closes,
    /// It opens from a point in the source.
    Opens,
}
