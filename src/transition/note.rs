//! What was done otherwise than asked while a transition was built.

#[cfg(doc)]
use crate::compatible::CompatibleMesh;
use crate::compatible::FrameOutlinesError;
use crate::correspondence::{MatchNote, RegionMatch, RegionMatchError};
use serde::{Serialize, Serializer};
use std::fmt;

/// Something that could not be done as it was asked for, and what was done
/// instead, or what might be better. The transition plays all the same. Serialised as its words.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TransitionNote {
    /// The outlines were matched otherwise than asked.
    Match(MatchNote),
    /// Pins that were found were thinned out until the frame did not fold.
    FewerPins {
        /// How many are left.
        left: usize,
        /// How many were found.
        of: usize,
    },
    /// The outlines could not be edges of the frame's mesh; pins along them
    /// carry it.
    NotByOutlines(FrameOutlinesError),
    /// Pins on the outlines do not match them; the pins alone carry the frame.
    NotMatched(RegionMatchError),
    /// The designs would match far better if one of them were mirrored.
    Mirrored {
        /// The mean distortion as they are, as [`CompatibleMesh::distortion`].
        as_drawn: f64,
        /// That of a first film of them.
        mirrored: f64,
    },
    /// Fields of distances that are not Euclidean have their boundary between
    /// cells, although it was to be exact.
    BinaryBoundary,
    /// Drawings have more paints or parts than there can be fields.
    OneColour,
    /// Parts were to have times of their own, which only rigid parts have.
    OneTime,
    /// The equations of rigid parts could only be solved with a little added
    /// to their diagonal.
    Stiffened {
        /// How much, as a share of the diagonal.
        share: f64,
    },
    /// Parts could not be flattened as bounded distortion asks; each of their faces
    /// goes its own way.
    Unflattened {
        /// How many.
        parts: usize,
    },
}

impl TransitionNote {
    /// What a match could not do as it was asked for.
    pub(super) fn of_match(matched: &RegionMatch) -> impl Iterator<Item = Self> {
        matched.notes().copied().map(Self::Match)
    }
}

impl fmt::Display for TransitionNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Match(note) => note.fmt(f),
            Self::FewerPins { left, of } => write!(
                f,
                "{left} of the {of} pins that were found are used: with more of them the plane would fold"
            ),
            Self::NotByOutlines(error) => write!(
                f,
                "pins along the outlines carry the plane, not the outlines themselves: {error}"
            ),
            Self::NotMatched(error) => write!(
                f,
                "the pins alone carry the plane, not the outlines that they lie on: {error}"
            ),
            Self::Mirrored { as_drawn, mirrored } => write!(
                f,
                "mirrored, one design would match the other far better (conformal distortion {mirrored:.1} instead of {as_drawn:.1}): mirror a drawing if that is meant"
            ),
            Self::BinaryBoundary => write!(
                f,
                "the boundary runs between cells: only Euclidean distances have it exactly"
            ),
            Self::OneColour => write!(
                f,
                "the drawings are shown in one colour: they have more paints or parts than fields can be mixed; choose fewer cells, or rigid parts"
            ),
            Self::OneTime => write!(
                f,
                "all parts move in the same time: only rigid parts may have times of their own"
            ),
            Self::Unflattened { parts } => write!(
                f,
                "{parts} of the parts cannot be kept from being sheared more on the way than at the ends: their triangles change too unlike each other; choose polar, or another match"
            ),
            Self::Stiffened { share } => write!(
                f,
                "faces of very different sizes: {share:.0e} of the diagonal was added to the equations to solve them"
            ),
        }
    }
}

impl Serialize for TransitionNote {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_says_what_was_done_instead() {
        let cut = RegionMatchError::Cut(1);
        for (note, words) in [
            (
                TransitionNote::FewerPins { left: 12, of: 24 },
                "12 of the 24 pins",
            ),
            (
                TransitionNote::NotByOutlines(FrameOutlinesError::Nesting),
                "lie within each other in different ways",
            ),
            (
                TransitionNote::NotMatched(cut),
                "cut 2 does not run straight",
            ),
            (
                TransitionNote::Match(MatchNote::PinLeftOut(0)),
                "pin 1 is left out",
            ),
            (TransitionNote::BinaryBoundary, "between cells"),
            (
                TransitionNote::Mirrored {
                    as_drawn: 8.0,
                    mirrored: 1.1,
                },
                "1.1 instead of 8.0",
            ),
            (
                TransitionNote::Stiffened { share: 1e-11 },
                "1e-11 of the diagonal",
            ),
            (TransitionNote::Unflattened { parts: 2 }, "2 of the parts"),
        ] {
            let said = note.to_string();
            assert!(said.contains(words) && !said.contains('\n'), "{said}");
            let json = serde_json::to_value(&note).expect("words");
            assert_eq!(json, said);
        }
    }
}
