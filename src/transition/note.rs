//! Notes on a built transition: deviations from the requested options, and suggestions.

use super::common_frame::FittedPage;
#[cfg(doc)]
use crate::compatible::CompatibleMesh;
use crate::compatible::FrameOutlinesError;
use crate::correspondence::{MatchNote, RegionMatch, RegionMatchError};
use serde::{Serialize, Serializer};
use std::fmt;

/// A deviation from the requested options with its reason, or a suggestion. The transition is built
/// nevertheless. Serialised as the text of its message.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TransitionNote {
    /// The match of the outlines deviates from the request.
    Match(MatchNote),
    /// Automatic pins were thinned out until the warp of the plane had no folds.
    FewerPins {
        /// Number of pins that are used.
        left: usize,
        /// Number of automatic pins before they were thinned out.
        of: usize,
    },
    /// The plane follows pins along the outlines, because the plane could not be triangulated with
    /// the outlines as mesh edges.
    PinsInsteadOfOutlines(FrameOutlinesError),
    /// The plane follows the pins alone, because the outlines on which they lie could not be
    /// matched.
    PinsUnmatched(RegionMatchError),
    /// The designs would match far better if one of them were mirrored.
    Mirrored {
        /// Mean distortion of the best match if neither design is mirrored; see
        /// [`CompatibleMesh::distortion`].
        as_drawn: f64,
        /// Mean distortion with one design mirrored, for a match that was not improved by a search.
        mirrored: f64,
    },
    /// An exact boundary was requested, but the metric is not Euclidean: the boundary lies between
    /// grid cells.
    BinaryBoundary,
    /// The drawings are shown in one colour, because they have too many paints or parts to compute
    /// a distance field for each paint.
    PaintIgnored,
    /// A page was scaled to fit into the page of the first design.
    PageFitted(FittedPage),
    /// The trusses number their nodes differently; the nodes were paired by their bars and
    /// positions.
    NodesRenumbered,
    /// The match that is saved in the project does not belong to its designs, and another one was
    /// computed.
    CachedMatchIgnored,
    /// Parts are not paired by their names, because there are too many of them.
    NamesIgnored,
    /// Part timings were requested but ignored, because the method is not rigid parts.
    PartTimesIgnored,
    /// The equations of rigid parts could only be solved after small numbers were added to the
    /// diagonal of their matrix.
    DiagonalAdded {
        /// Amount added to the diagonal, as a fraction of the diagonal.
        share: f64,
    },
    /// The positions of some parts that exist in only one design were not searched, because the
    /// search had reached its limit of work.
    PartsUnsearched {
        /// Number of these parts.
        parts: usize,
    },
    /// Some parts could not be moved with bounded distortion. In these parts, each face is
    /// interpolated on its own instead.
    Unflattened {
        /// Number of parts that could not be moved with bounded distortion.
        parts: usize,
    },
}

impl TransitionNote {
    /// Returns the notes of a match.
    pub(super) fn of_match(matched: &RegionMatch) -> impl Iterator<Item = Self> {
        matched.notes().copied().map(Self::Match)
    }
}

impl TransitionNote {
    /// Returns the text of a note that has no numbers or names in it; empty for other notes.
    fn fixed_text(&self) -> &'static str {
        match self {
            Self::BinaryBoundary => {
                "the boundary runs between cells: only the Euclidean metric can place it exactly"
            }
            Self::PaintIgnored => {
                "the drawings are shown in one colour: they have too many colours or parts for distance fields; use fewer cells, or rigid parts"
            }
            Self::NodesRenumbered => {
                "the nodes of the trusses were paired by their bars and positions, because their numbers differ"
            }
            Self::CachedMatchIgnored => {
                "the match saved in the project does not belong to its designs, so another one was computed; save the project to keep it"
            }
            Self::NamesIgnored => {
                "parts are not paired by their names: there are too many of them; remove small parts, or use fewer cells"
            }
            Self::PartTimesIgnored => {
                "all parts move at the same time: only rigid parts can have part timings"
            }
            _ => "",
        }
    }
}

impl fmt::Display for TransitionNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Match(note) => note.fmt(f),
            Self::FewerPins { left, of } => write!(
                f,
                "only {left} of the {of} automatic pins are used: with more, the plane would fold"
            ),
            Self::PinsInsteadOfOutlines(error) => write!(
                f,
                "the plane follows pins along the outlines instead of the outlines themselves: {error}"
            ),
            Self::PinsUnmatched(error) => write!(
                f,
                "the plane follows the pins alone, not the outlines on which they lie: {error}"
            ),
            Self::Mirrored { as_drawn, mirrored } => write!(
                f,
                "the designs would match far better if one were mirrored (conformal distortion {mirrored:.1} instead of {as_drawn:.1}): flip one horizontally if that is intended"
            ),
            Self::PageFitted(page) => page.fmt(f),
            Self::PartsUnsearched { parts } => write!(
                f,
                "{parts} of the parts that appear or disappear may cross others: there are too many for a search of all positions; remove small parts, or blend distance fields"
            ),
            Self::Unflattened { parts } => write!(
                f,
                "{parts} of the parts are sheared more in between than at the ends: their triangles change too differently; choose polar interpolation, or another match"
            ),
            Self::DiagonalAdded { share } => write!(
                f,
                "faces differ very much in size, so {share:.0e} of the diagonal was added to the equations to make them solvable"
            ),
            Self::BinaryBoundary
            | Self::PaintIgnored
            | Self::NodesRenumbered
            | Self::CachedMatchIgnored
            | Self::NamesIgnored
            | Self::PartTimesIgnored => f.write_str(self.fixed_text()),
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
    fn a_note_reports_what_was_done_instead() {
        let cut = RegionMatchError::Cut(1);
        for (note, expected) in [
            (
                TransitionNote::FewerPins { left: 12, of: 24 },
                "12 of the 24 automatic pins",
            ),
            (
                TransitionNote::PinsInsteadOfOutlines(FrameOutlinesError::Nesting),
                "nested differently in the two designs",
            ),
            (TransitionNote::PinsUnmatched(cut), "cut 2 leaves its part"),
            (
                TransitionNote::Match(MatchNote::PinLeftOut(0)),
                "pin 1 is ignored",
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
                TransitionNote::DiagonalAdded { share: 1e-11 },
                "1e-11 of the diagonal",
            ),
            (
                TransitionNote::PartsUnsearched { parts: 4 },
                "4 of the parts that appear",
            ),
            (TransitionNote::Unflattened { parts: 2 }, "2 of the parts"),
        ] {
            let message = note.to_string();
            assert!(
                message.contains(expected) && !message.contains('\n'),
                "{message}"
            );
            let json = serde_json::to_value(&note).expect("words");
            assert_eq!(json, message);
        }
    }
}
