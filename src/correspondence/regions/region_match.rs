//! The result of matching two designs, the notes about requests that could not be fulfilled, and
//! the errors.

#[cfg(doc)]
use super::super::HoleRule;
use super::super::shared_polygons::SharedPolygons;
use super::super::{MatchError, PairError, PinError, RingCut};
use super::matched_curves::MatchedCurves;
use crate::geometry::{DVec2, Side, SourceTarget};
use crate::work::progress::Cancelled;
use serde::{Deserialize, Serialize};

/// Diameter of the tiny ring that represents a point, as a fraction of the diameter of the part in
/// which it lies or to which it grows (tolerance: one pixel on a screen that is 4,000 pixels wide).
pub const POINT_SIZE: f64 = 2.5e-4;

/// Match of two whole designs.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionMatch {
    /// The pieces, in the order of the source's parts; pieces that exist only in the target come
    /// last.
    pub pieces: Vec<PieceMatch>,
}

/// Match of one piece: a connected region of one design with a connected region, or a point, of the
/// other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceMatch {
    /// Rings of the piece: the outer ring first, counter-clockwise, then the holes, clockwise.
    pub rings: Vec<RingMatch>,
    /// Holes that exist in only one design and are excluded from the piece
    /// ([`HoleRule::Transient`]). In that design, each is a clockwise ring. In the other design, it
    /// is a tiny ring that represents a point.
    pub lone: Vec<RingMatch>,
    /// Index of the source's part that contains the piece; `None` if the piece exists only in the
    /// target.
    pub source_part: Option<usize>,
    /// Index of the target's part that contains the piece; `None` if the piece exists only in the
    /// source.
    pub target_part: Option<usize>,
    /// Cuts that open the piece at holes.
    pub cuts: Vec<RingCut>,
    /// Rotation of the source's outer ring that best aligns it with the target's, in radians in
    /// (−π, π].
    pub rotation: f64,
    /// Dissimilarity of the matched outer rings, see
    /// [`crate::correspondence::BoundaryMatch::cost`]; 0 for pieces that appear or disappear.
    pub cost: f64,
    /// Notes about requests that could not be fulfilled.
    pub notes: Vec<MatchNote>,
}

/// Request that a match could not fulfil, and its substitute. The indices of parts, holes and pins
/// start at 0 in the fields and at 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum MatchNote {
    /// A hole closes to a point, or opens from one. It should have been cut open, but no straight
    /// cut reaches it.
    #[error("hole {} of part {} of the {side} is not cut open: no straight cut to it stays inside the part; draw a cut", hole + 1, part + 1)]
    Uncut {
        /// Design that contains the hole.
        side: Side,
        /// Index of the part that contains the hole.
        part: usize,
        /// Index of the hole in the part.
        hole: usize,
    },
    /// The pin with this index, which ties a hole to an outer boundary, is ignored, because the
    /// hole is not cut open.
    #[error("pin {} is ignored because its hole is not cut open; draw a cut, or delete the pin", .0 + 1)]
    PinLeftOut(usize),
    /// A part is matched with only one of several parts; the others appear or disappear.
    #[error("part {} of the {side} is not split: no suitable straight cut was found; link corresponding parts by hand", part + 1)]
    Unsplit {
        /// Design that contains the part.
        side: Side,
        /// Index of the part.
        part: usize,
    },
}

/// Corresponding vertices of one ring: vertex k of the source corresponds to vertex k of the
/// target.
///
/// If a part was cut open, its ring runs along the slit twice, there and back, through exactly the
/// same points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RingMatch {
    /// Vertices in the source.
    pub source: Vec<DVec2>,
    /// Vertices in the target.
    pub target: Vec<DVec2>,
    /// Whether the ring is matched with a ring, closes to a point or opens from one.
    pub kind: RingKind,
    /// The matched curves from which the vertices derive; `None` if the ring exists in only one
    /// design, or was read from a file.
    #[serde(skip)]
    pub(crate) course: Option<MatchedCurves>,
}

/// Way in which a ring changes between the designs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RingKind {
    /// The ring is matched with a ring of the other design.
    Matched,
    /// The ring exists in the source and closes to a point in the target.
    Closes,
    /// The ring exists in the target and opens from a point in the source.
    Opens,
}

/// Reason why two designs were not matched. The indices of pins and cuts start at 0 in the fields
/// and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionMatchError {
    /// Links or pins contradict each other.
    #[error(transparent)]
    Pairs(#[from] PairError),
    /// Pins on one boundary contradict each other; their indices are those among all pins.
    #[error("{0}")]
    Pins(PinError),
    /// A coordinate of a pin, link, cut or unmatched part is not finite. The index counts all pins,
    /// then all links, cuts and unmatched parts.
    #[error("pin, link or cut {} has a coordinate that is not finite; place it again", .0 + 1)]
    NotFinite(usize),
    /// The pin with this index ties a hole to an outer boundary, but the rule is that unmatched
    /// holes close.
    #[error("pin {} ties a hole to an outer boundary; let the ring be cut open, or delete the pin", .0 + 1)]
    PinAcross(usize),
    /// The cut with this index does not run straight inside its part from the hole to a boundary.
    #[error("cut {} leaves its part; move its ends", .0 + 1)]
    Cut(usize),
    /// Two boundaries cannot be matched.
    #[error(transparent)]
    Match(#[from] MatchError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<Vec<PieceMatch>> for RegionMatch {
    fn from(pieces: Vec<PieceMatch>) -> Self {
        Self { pieces }
    }
}

impl RegionMatch {
    /// Returns the notes about requests that could not be fulfilled, piece by piece.
    pub fn notes(&self) -> impl Iterator<Item = &MatchNote> {
        self.pieces.iter().flat_map(|piece| &piece.notes)
    }
}

impl PieceMatch {
    /// Returns whether the piece exists in both designs.
    #[must_use]
    pub fn is_matched(&self) -> bool {
        self.only_side().is_none()
    }

    /// Returns the design that contains the piece, if only one does.
    pub(crate) fn only_side(&self) -> Option<Side> {
        match (self.source_part, self.target_part) {
            (Some(_), Some(_)) => None,
            (Some(_), None) => Some(Side::Source),
            (None, _) => Some(Side::Target),
        }
    }

    /// Returns the piece with the vertices of its rings moved to other places. `places` holds a
    /// list for each ring, as returned by [`MatchedCurves::places`].
    pub(crate) fn with_ring_places(&self, places: &[Vec<[f64; 2]>]) -> Self {
        let mut result = self.clone();
        for (ring, places) in result.rings.iter_mut().zip(places) {
            if let Some(course) = &ring.course {
                let (curves, polygons) = course.with_places(places);
                *ring = RingMatch::from_curves(curves, polygons);
            }
        }
        result
    }
}

impl RingMatch {
    /// If the ring exists in only one design, returns that design and the ring's vertices there.
    #[must_use]
    pub fn transient_side(&self) -> Option<(Side, &[DVec2])> {
        match self.kind {
            RingKind::Matched => None,
            RingKind::Closes => Some((Side::Source, &self.source)),
            RingKind::Opens => Some((Side::Target, &self.target)),
        }
    }

    /// Returns whether the ring has the same number of vertices in both designs, at least three,
    /// and all are finite.
    pub(crate) fn is_sound(&self) -> bool {
        let mut points = self.source.iter().chain(&self.target);
        self.source.len() == self.target.len()
            && self.source.len() >= 3
            && points.all(|point| point.is_finite())
    }

    /// Creates a matched ring from two matched curves and the two polygons with corresponding
    /// vertices along them.
    pub(super) fn from_curves(curves: MatchedCurves, polygons: SharedPolygons) -> Self {
        Self {
            source: polygons.source,
            target: polygons.target,
            kind: RingKind::Matched,
            course: Some(curves),
        }
    }

    /// Creates a ring that exists only in the design `side`. `whole` holds its vertices there;
    /// `point` holds the tiny ring that represents a point in the other design.
    pub(super) fn transient(side: Side, whole: Vec<DVec2>, point: Vec<DVec2>) -> Self {
        let kind = match side {
            Side::Source => RingKind::Closes,
            Side::Target => RingKind::Opens,
        };
        let SourceTarget { source, target } = SourceTarget::with_side(side, whole, point);
        Self {
            source,
            target,
            kind,
            course: None,
        }
    }
}
