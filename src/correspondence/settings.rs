//! The user's settings for matching two designs: pins, linked parts, cuts and rules.
//!
//! Parts, holes and boundary points are always identified by coordinates in the designs, never by
//! index. The settings therefore remain valid when a design is redrawn.

use super::MatchOptions;
use crate::geometry::{DVec2, RANGE_MESSAGE, Side, Similarity, SourceTarget, is_in_range};
use crate::settings::named;
use serde::{Deserialize, Serialize};

/// Settings for matching two designs.
///
/// ```
/// use morphospace::correspondence::{HoleRule, MatchSettings};
/// assert_eq!(MatchSettings::default().holes, HoleRule::Auto);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MatchSettings {
    /// Whether "up" stays up: directions are compared as drawn instead of up to a rotation.
    pub keep_up: bool,
    /// Weight of stretching (differing arc lengths) relative to bending (differing outlines), at
    /// least 0. If `None`, the weight is 0.25; for dissimilar shapes several weights are tried, and
    /// the one with the best transition is used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stretch: Option<f64>,
    /// Weight of differences in the shapes' thickness, at least 0; 1 if `None`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Treatment of holes that exist in only one design.
    pub holes: HoleRule,
    /// Treatment of parts that exist in only one design.
    pub parts: PartRule,
    /// Pairs of corresponding boundary points. A pin also pairs the parts and the holes that it
    /// lies on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<PointPair>,
    /// Pairs of corresponding lines, such as a nose or the edge of a wing, for warps of the plane.
    /// Each warp uses pins and lines as far as it supports them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lines: Vec<LinePair>,
    /// Pairs of corresponding parts, each identified by a point in or near it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<PointPair>,
    /// Parts that must stay unmatched, even if the other design has a similar part.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lone: Vec<UnmatchedPart>,
    /// Cuts that open parts at holes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<RingCut>,
}

/// A point of the source and the corresponding point of the target, each in its own design's
/// coordinates.
pub type PointPair = SourceTarget<DVec2>;

/// A line of the source and the corresponding line of the target, each from start to end, in its
/// own design's coordinates.
pub type LinePair = SourceTarget<[DVec2; 2]>;

/// A part that must stay unmatched: it appears or disappears.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct UnmatchedPart {
    /// Design that contains the part.
    pub side: Side,
    /// Point in or near the part, in the design's own coordinates.
    pub at: DVec2,
}

/// A straight cut from a hole to another boundary of its part. The part opens along the cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RingCut {
    /// Design that is cut.
    pub side: Side,
    /// Point near the end of the cut that lies on the part's outer boundary or on another hole.
    pub outer: DVec2,
    /// Point near the end of the cut that lies on the hole.
    pub hole: DVec2,
}

/// Error: a coordinate of a setting is not finite, or is out of range. Indices start at 1 in
/// messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} {} {RANGE_MESSAGE}", index + 1)]
pub struct MatchSettingsError {
    /// Kind of the setting: "pin", "line", "link", "unmatched part" or "cut".
    pub what: &'static str,
    /// Index of the setting in the list of that kind, from 0.
    pub index: usize,
}

/// Treatment of a hole that has no partner in the other design.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum HoleRule {
    /// The rule that gives the best transition is used. If no transition is built, the hole closes
    /// or is cut open, whichever matches better; in designs with more than 32 rings, holes close.
    #[default]
    Auto,
    /// The hole closes to a point, or opens from one. The part deforms around it.
    Close,
    /// The part is cut open along a straight line from the hole to another boundary.
    Cut,
    /// The part moves as if it had no such hole. The hole shrinks to nothing or grows from nothing
    /// inside the part, without deforming it.
    Transient,
}

named! { HoleRule {
    Auto: "auto", "Auto", "Uses the rule that gives the best film";
    Close: "close", "Close",
        "The hole closes to a point, or opens from one; the part deforms around it";
    Cut: "cut", "Cut", "The ring around the hole is cut open and unrolls";
    Transient: "alone", "Appear or disappear",
        "The hole grows or shrinks; the part moves as if it had no hole";
} }

/// Treatment of a part that has no partner in the other design.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PartRule {
    /// If one design is a single part, that part is split into several. A part with less than a
    /// thousandth of its design's area causes no split. If both designs have several parts,
    /// unmatched parts appear and disappear.
    #[default]
    Auto,
    /// The nearest part of the other design is split, and one piece of it is matched with the
    /// unmatched part.
    Split,
    /// The part grows from a point, or shrinks to one.
    Transient,
}

named! { PartRule {
    Auto: "auto", "Auto",
        "A single part is split into several; otherwise unmatched parts appear or disappear";
    Split: "split", "Split",
        "The best-fitting part of the other design is cut into one piece for each";
    Transient: "alone", "Appear or disappear", "The part grows from a point, or shrinks to one";
} }

impl PointPair {
    /// Returns the pair with each point transformed by its design's similarity.
    #[must_use]
    pub fn placed(&self, [source, target]: &[Similarity; 2]) -> Self {
        Self {
            source: source.apply(self.source),
            target: target.apply(self.target),
        }
    }
}

impl LinePair {
    /// Returns the pair with each line transformed by its design's similarity.
    #[must_use]
    pub fn placed(&self, [source, target]: &[Similarity; 2]) -> Self {
        Self {
            source: self.source.map(|p| source.apply(p)),
            target: self.target.map(|p| target.apply(p)),
        }
    }
}

impl UnmatchedPart {
    /// Returns the same part after source and target are exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..*self
        }
    }
}

impl RingCut {
    /// Returns the same cut after source and target are exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..*self
        }
    }
}

impl MatchSettings {
    /// Returns the settings without those that contain coordinates (pins, lines, links, unmatched
    /// parts and cuts), for use with other designs.
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

    /// Checks that all coordinates are finite and in range.
    ///
    /// # Errors
    /// [`MatchSettingsError`] names the first pin, line, link, unmatched part or cut that has an
    /// invalid coordinate.
    pub fn check(&self) -> Result<(), MatchSettingsError> {
        let is_pair_valid =
            |pair: &PointPair| [pair.source, pair.target].map(is_in_range) == [true; 2];
        let is_line_valid = |line: &LinePair| {
            let ends = line.source.iter().chain(&line.target);
            ends.copied().all(is_in_range)
        };
        let is_cut_valid = |cut: &RingCut| is_in_range(cut.outer) && is_in_range(cut.hole);
        check_all("pin", &self.pins, is_pair_valid)?;
        check_all("line", &self.lines, is_line_valid)?;
        check_all("link", &self.links, is_pair_valid)?;
        check_all("unmatched part", &self.lone, |part| is_in_range(part.at))?;
        check_all("cut", &self.cuts, is_cut_valid)
    }

    /// Returns the options with which each pair of boundaries is matched.
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

    /// Returns the settings with all coordinates transformed by the similarity of their design.
    #[must_use]
    pub fn placed(&self, maps: &[Similarity; 2]) -> Self {
        let pairs = |pairs: &[PointPair]| pairs.iter().map(|p| p.placed(maps)).collect();
        let cut = |cut: &RingCut| {
            let map = &maps[cut.side];
            RingCut {
                side: cut.side,
                outer: map.apply(cut.outer),
                hole: map.apply(cut.hole),
            }
        };
        let unmatched = |part: &UnmatchedPart| UnmatchedPart {
            at: maps[part.side].apply(part.at),
            ..*part
        };
        Self {
            pins: pairs(&self.pins),
            lines: self.lines.iter().map(|line| line.placed(maps)).collect(),
            links: pairs(&self.links),
            lone: self.lone.iter().map(unmatched).collect(),
            cuts: self.cuts.iter().map(cut).collect(),
            ..*self
        }
    }

    /// Returns the settings after source and target are exchanged.
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

/// Returns an error that names the first invalid item, if any.
fn check_all<T>(
    what: &'static str,
    items: &[T],
    is_valid: impl Fn(&T) -> bool,
) -> Result<(), MatchSettingsError> {
    match items.iter().position(|item| !is_valid(item)) {
        Some(index) => Err(MatchSettingsError { what, index }),
        None => Ok(()),
    }
}

fn swapped<T: Copy>(pairs: &[SourceTarget<T>]) -> Vec<SourceTarget<T>> {
    pairs.iter().map(|pair| pair.swapped()).collect()
}
