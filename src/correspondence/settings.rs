//! What a person may say about a match: pins, pairs of parts, cuts, rules.
//!
//! Everything is said by points of the designs, never by numbers of outlines:
//! a design that is drawn anew keeps what was said of it.

use super::MatchOptions;
use crate::geometry::{DVec2, RANGE_MESSAGE, Side, Similarity, SourceTarget, is_in_range};
use crate::settings::choice::named;
use serde::{Deserialize, Serialize};

/// How two designs are matched.
///
/// ```
/// use morphospace::correspondence::{HoleRule, Matching};
/// assert_eq!(Matching::default().holes, HoleRule::Auto);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MatchSettings {
    /// Keep "up": compare directions as drawn instead of up to a rotation.
    pub keep_up: bool,
    /// Price of stretch against bending, at least 0; where it is not given,
    /// several are tried if the shapes are unlike, and the best film is kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stretch: Option<f64>,
    /// Price of differing thickness, at least 0; 1 where it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// What becomes of holes that only one design has.
    pub holes: HoleRule,
    /// What becomes of parts that only one design has.
    pub parts: PartRule,
    /// Points of the boundaries that are the same. A pin pairs the parts, and
    /// the holes, that it lies on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<PointPair>,
    /// Lines that are the same, for warps of the plane: a nose, the edge of a
    /// wing. Each warp reads pins and lines as it can.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lines: Vec<LinePair>,
    /// Parts that are the same, each named by a point in or near it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<PointPair>,
    /// Parts without a partner, whatever looks like one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lone: Vec<UnmatchedPart>,
    /// Where rings are cut open.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<RingCut>,
}

/// A point of the source and one of the target, in each design's own
/// coordinates.
pub type PointPair = SourceTarget<DVec2>;

/// A line of the source and one of the target, each from end to end, in each
/// design's own coordinates.
pub type LinePair = SourceTarget<[DVec2; 2]>;

/// A part that has no partner: it appears or vanishes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct UnmatchedPart {
    /// The design that has it.
    pub side: Side,
    /// A point in or near it, in the design's own coordinates.
    pub at: DVec2,
}

/// A cut that opens a ring: straight from a hole to the boundary around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RingCut {
    /// The design that is cut.
    pub side: Side,
    /// A point near the end on the outer boundary, or on another hole.
    pub outer: DVec2,
    /// A point near the end on the hole.
    pub hole: DVec2,
}

/// A place that cannot be meant. Places count from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} {} {RANGE_MESSAGE}", index + 1)]
pub struct MatchPlaceError {
    /// What has it: a pin, a line, a link or a cut.
    pub what: &'static str,
    /// Its index.
    pub index: usize,
}

/// What becomes of a hole without a partner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum HoleRule {
    /// Whichever of these gives the better film; without one, whichever of the
    /// first two matches better, and where a design has more than 32 rings, it
    /// closes.
    #[default]
    Auto,
    /// The hole closes to a point, or opens from one.
    Close,
    /// The ring around it is cut open.
    Cut,
    /// The part moves as if it had no such hole, which shrinks away in it, or
    /// grows, without bending it.
    Alone,
}

named! { HoleRule {
    Auto: "auto", "Auto", "Whichever of these gives the better film";
    Close: "close", "Close", "The part flows together around it, or apart";
    Cut: "cut", "Cut", "The ring around the hole is cut open and uncoils";
    Alone: "alone", "Alone", "It shrinks away, or grows, in a part that moves as without it";
} }

/// What becomes of a part without a partner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PartRule {
    /// A single part is split into several, but not for one with less than a
    /// thousandth of its design's area; of several parts and several, the odd ones
    /// are born and die.
    #[default]
    Auto,
    /// The other design's part that fits best is split.
    Split,
    /// It is born from a point, or dies into one.
    Alone,
}

named! { PartRule {
    Auto: "auto", "Auto",
        "One part is split into several; among several, the odd ones appear or vanish";
    Split: "split", "Split", "The part that fits best is cut in pieces, one for each";
    Alone: "alone", "Alone", "It grows from a point, or shrinks to one";
} }

impl PointPair {
    /// The points sent through one map each.
    #[must_use]
    pub fn placed(&self, [source, target]: &[Similarity; 2]) -> Self {
        Self {
            source: source.apply(self.source),
            target: target.apply(self.target),
        }
    }
}

impl LinePair {
    /// The lines sent through one map each.
    #[must_use]
    pub fn placed(&self, [source, target]: &[Similarity; 2]) -> Self {
        Self {
            source: self.source.map(|p| source.apply(p)),
            target: self.target.map(|p| target.apply(p)),
        }
    }
}

impl UnmatchedPart {
    /// The same part of the designs exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..*self
        }
    }
}

impl RingCut {
    /// The same cut of the designs exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..*self
        }
    }
}

impl MatchSettings {
    /// The same without all that is said of points: for other designs.
    #[must_use]
    pub fn without_places(&self) -> Self {
        Self {
            pins: Vec::new(),
            lines: Vec::new(),
            links: Vec::new(),
            lone: Vec::new(),
            cuts: Vec::new(),
            ..*self
        }
    }

    /// Checks that all places are numbers that can be reckoned with.
    ///
    /// # Errors
    /// [`MatchPlaceError`] names the first pin, line, link, lone part or cut that has others.
    pub fn check(&self) -> Result<(), MatchPlaceError> {
        let of_pair = |pair: &PointPair| [pair.source, pair.target].map(is_in_range) == [true; 2];
        let of_line = |line: &LinePair| {
            let ends = line.source.iter().chain(&line.target);
            ends.copied().all(is_in_range)
        };
        let of_cut = |cut: &RingCut| is_in_range(cut.outer) && is_in_range(cut.hole);
        first("pin", &self.pins, of_pair)?;
        first("line", &self.lines, of_line)?;
        first("link", &self.links, of_pair)?;
        first("lone part", &self.lone, |part| is_in_range(part.at))?;
        first("cut", &self.cuts, of_cut)
    }

    /// How each pair of boundaries is matched.
    #[must_use]
    pub fn options(&self) -> MatchOptions {
        let default = MatchOptions::default();
        MatchOptions {
            keep_up: self.keep_up,
            stretch: self.stretch.unwrap_or(default.stretch),
            thickness: self.thickness.unwrap_or(default.thickness),
            ..default
        }
    }

    /// The same said of designs that were laid down by one similarity each.
    #[must_use]
    pub fn placed(&self, by: &[Similarity; 2]) -> Self {
        let pairs = |pairs: &[PointPair]| pairs.iter().map(|p| p.placed(by)).collect();
        let cut = |cut: &RingCut| {
            let by = &by[cut.side];
            RingCut {
                side: cut.side,
                outer: by.apply(cut.outer),
                hole: by.apply(cut.hole),
            }
        };
        let lone = |part: &UnmatchedPart| UnmatchedPart {
            at: by[part.side].apply(part.at),
            ..*part
        };
        Self {
            pins: pairs(&self.pins),
            lines: self.lines.iter().map(|line| line.placed(by)).collect(),
            links: pairs(&self.links),
            lone: self.lone.iter().map(lone).collect(),
            cuts: self.cuts.iter().map(cut).collect(),
            ..*self
        }
    }

    /// The same said of the designs exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            pins: swapped(&self.pins),
            lines: swapped(&self.lines),
            links: swapped(&self.links),
            lone: self.lone.iter().map(UnmatchedPart::swapped).collect(),
            cuts: self.cuts.iter().map(RingCut::swapped).collect(),
            ..*self
        }
    }
}

/// The first that is not good, as an error.
fn first<T>(
    what: &'static str,
    all: &[T],
    is_good: impl Fn(&T) -> bool,
) -> Result<(), MatchPlaceError> {
    match all.iter().position(|one| !is_good(one)) {
        Some(index) => Err(MatchPlaceError { what, index }),
        None => Ok(()),
    }
}

fn swapped<T: Copy>(pairs: &[SourceTarget<T>]) -> Vec<SourceTarget<T>> {
    pairs.iter().map(|pair| pair.swapped()).collect()
}
