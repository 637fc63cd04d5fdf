//! What the match of two designs is, and why there is none.

#[cfg(doc)]
use super::super::HoleRule;
use super::super::shared_polygons::SharedPolygons;
use super::super::{MatchError, PairError, PinError, RingCut};
use super::matched_curves::MatchedCurves;
use crate::geometry::{DVec2, Side, SourceTarget};
use crate::work::progress::Cancelled;
use serde::{Deserialize, Serialize};

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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceMatch {
    /// The outer ring first, counter-clockwise, then holes, clockwise.
    pub rings: Vec<RingMatch>,
    /// Holes that one of the designs has alone, clockwise there and a point in
    /// the other, which the rest is matched without: [`HoleRule::Alone`].
    pub lone: Vec<RingMatch>,
    /// Which of the source's parts it is, or is cut from; none if it is born.
    pub source_part: Option<usize>,
    /// Which of the target's parts it is, or is cut from; none if it dies.
    pub target_part: Option<usize>,
    /// Where rings were cut open: the ends on the outer boundary and on the
    /// hole.
    pub cuts: Vec<RingCut>,
    /// The rotation that lays the source's outer ring onto the target's, in
    /// radians in (−π, π].
    pub rotation: f64,
    /// How unlike the outer rings are as matched; see
    /// [`crate::correspondence::BoundaryMatch::cost`]. 0 for what is born or dies.
    pub cost: f64,
    /// What was not done as it was asked for.
    pub notes: Vec<MatchNote>,
}

/// What a match could not do as it was asked for, and did otherwise. Parts,
/// holes and pins are counted from 0, and from 1 in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum MatchNote {
    /// A hole closes, or opens, since no straight cut leads to it.
    #[error("hole {} of part {} of the {side} is not cut open: no straight cut leads to it inside the part; draw one", hole + 1, part + 1)]
    Uncut {
        /// In which design.
        side: Side,
        /// In which part.
        part: usize,
        /// Which hole.
        hole: usize,
    },
    /// A pin ties a hole to an outer boundary, and the hole is not cut open.
    #[error("pin {} is left out: the hole that it lies on is not cut open; draw a cut, or delete the pin", .0 + 1)]
    PinLeftOut(usize),
    /// A part is matched with one of several; the others are born or die.
    #[error("part {} of the {side} is not split: no straight cut through it was found; link the parts that belong together", part + 1)]
    Unsplit {
        /// In which design.
        side: Side,
        /// Which part.
        part: usize,
    },
}

/// Corresponding vertices of one ring. Vertex k of the source is vertex k of
/// the target.
///
/// A ring that was cut open runs along its cut twice, there and back, through
/// the same points bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RingMatch {
    /// Vertices on the source.
    pub source: Vec<DVec2>,
    /// Vertices on the target.
    pub target: Vec<DVec2>,
    /// What becomes of the ring.
    pub kind: RingKind,
    /// How it was matched; none where it is alone, or was not matched here.
    #[serde(skip)]
    pub(crate) course: Option<MatchedCurves>,
}

/// What becomes of a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RingKind {
    /// It is matched with another.
    Matched,
    /// It closes to a point in the target.
    Closes,
    /// It opens from a point in the source.
    Opens,
}

/// Why two designs were not matched. Pins are counted from 1 in messages, in
/// the order given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionMatchError {
    /// Links or pins that contradict each other.
    #[error(transparent)]
    Pairs(#[from] PairError),
    /// Pins on one boundary that contradict each other; their indices are
    /// those of all pins.
    #[error("{0}")]
    Pins(PinError),
    /// A pin, a link or a cut is not finite.
    #[error("pin, link or cut {} is not finite; place it anew", .0 + 1)]
    NotFinite(usize),
    /// A pin ties a hole to an outer boundary although holes close.
    #[error("pin {} ties a hole to an outer boundary; have the ring cut open, or delete the pin", .0 + 1)]
    PinAcross(usize),
    /// A cut does not run inside the ring from its hole to a boundary.
    #[error("cut {} does not run straight inside the part; move its ends", .0 + 1)]
    Cut(usize),
    /// Two boundaries cannot be measured.
    #[error(transparent)]
    Match(#[from] MatchError),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<Vec<PieceMatch>> for RegionMatch {
    fn from(pieces: Vec<PieceMatch>) -> Self {
        Self { pieces }
    }
}

impl RegionMatch {
    /// What was not done as it was asked for, piece by piece.
    pub fn notes(&self) -> impl Iterator<Item = &MatchNote> {
        self.pieces.iter().flat_map(|piece| &piece.notes)
    }
}

impl PieceMatch {
    /// Whether it is a part of both designs, neither born nor dying.
    #[must_use]
    pub fn is_in_both(&self) -> bool {
        self.alone().is_none()
    }

    /// The design that has it alone, if one has.
    pub(crate) fn alone(&self) -> Option<Side> {
        match (self.source_part, self.target_part) {
            (Some(_), Some(_)) => None,
            (Some(_), None) => Some(Side::Source),
            (None, _) => Some(Side::Target),
        }
    }

    /// The piece with the vertices of its rings at other places, ring by ring as
    /// `Course::places` has them.
    pub(crate) fn moved(&self, places: &[Vec<[f64; 2]>]) -> Self {
        let mut moved = self.clone();
        for (ring, places) in moved.rings.iter_mut().zip(places) {
            if let Some(course) = &ring.course {
                *ring = RingMatch::along(course.moved(places));
            }
        }
        moved
    }
}

impl RingMatch {
    /// The design that has it, and its vertices there, where only one has.
    #[must_use]
    pub fn whole(&self) -> Option<(Side, &[DVec2])> {
        match self.kind {
            RingKind::Matched => None,
            RingKind::Closes => Some((Side::Source, &self.source)),
            RingKind::Opens => Some((Side::Target, &self.target)),
        }
    }

    /// Whether both sides have as many vertices, and those a place.
    pub(crate) fn is_sound(&self) -> bool {
        let mut points = self.source.iter().chain(&self.target);
        self.source.len() == self.target.len()
            && self.source.len() >= 3
            && points.all(|point| point.is_finite())
    }

    /// A ring along two matched curves.
    pub(super) fn along((course, shared): (MatchedCurves, SharedPolygons)) -> Self {
        Self {
            source: shared.source,
            target: shared.target,
            kind: RingKind::Matched,
            course: Some(course),
        }
    }

    /// A ring of one design that is a point in the other.
    pub(super) fn alone(side: Side, whole: Vec<DVec2>, point: Vec<DVec2>) -> Self {
        let kind = match side {
            Side::Source => RingKind::Closes,
            Side::Target => RingKind::Opens,
        };
        let SourceTarget { source, target } = SourceTarget::on(side, whole, point);
        Self {
            source,
            target,
            kind,
            course: None,
        }
    }
}
