//! Determines the features that a plane warp follows: pins and lines set by the user, or automatic
//! ones along matched outlines.

use super::error::BuildError;
use super::note::TransitionNote;
use super::spec::TransitionSpec;
use crate::content::ContentKind;
use crate::correspondence::{
    HoleRule, LinePair, MatchSettings, PartRule, PointPair, RegionMatch, match_regions,
};
use crate::geometry::{Regions, Ring, Side};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, checkpoint};

/// Distance from an outline, as a fraction of the design's diameter, up to which a pin counts as
/// lying on the outline (tolerance: a few pixels in a window, the precision of dragging along a
/// line).
const ON_OUTLINE_DISTANCE: f64 = 0.005;

/// Number of automatic pins along each outline (heuristic; each pin adds an equation to the system
/// that determines the warp).
const AUTOMATIC_PINS: usize = 24;

/// Number of automatic lines along each outline (heuristic; lines act on the whole plane, and many
/// close together fold it).
const AUTOMATIC_LINES: usize = 10;

/// The features (pins and lines) that a plane warp follows.
#[derive(Default)]
pub(super) struct PlaneFeatures {
    pub points: Vec<PointPair>,
    pub lines: Vec<LinePair>,
    /// Whether the features are automatic, not set by the user.
    pub are_automatic: bool,
    /// The match of the outlines, if all features lie on matched outlines.
    pub matched: Option<RegionMatch>,
    /// Deviations from the request.
    pub notes: Vec<TransitionNote>,
}

impl PlaneFeatures {
    /// Returns the features set by the user. If there are none and outlines are visible, returns
    /// automatic features along matched outlines.
    ///
    /// # Errors
    /// If outlines cannot be computed or matched, or the work is cancelled.
    pub fn of(
        spec: &TransitionSpec,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let settings = &spec.options.matching;
        let requested = Self {
            points: settings.pins.clone(),
            lines: settings.lines.clone(),
            ..Self::default()
        };
        // The outline of a picture is invisible, so no automatic features are placed along it.
        if spec.method.content() != ContentKind::Field {
            return Ok(requested);
        }
        // A warp of the plane cannot cut a ring open or split a part, so the match must require
        // neither.
        let matching = MatchSettings {
            holes: HoleRule::Close,
            parts: PartRule::Transient,
            ..settings.clone()
        };
        let outlines = spec.outlines(bar_width, progress)?;
        if requested.points.is_empty() && requested.lines.is_empty() {
            return Self::automatic_features(spec.method.warp(), &outlines, &matching, progress);
        }
        // If all pins of the user lie on the outlines, these pins can guide a match of the
        // outlines.
        if spec.method.warp() == WarpKind::Arap && requested.are_on(&outlines) {
            return requested.with_match(&outlines, &matching, progress);
        }
        Ok(requested)
    }

    /// Returns automatic features along matched outlines.
    ///
    /// # Errors
    /// If the outlines cannot be matched or the work is cancelled.
    fn automatic_features(
        warp: WarpKind,
        [source, target]: &[Regions; 2],
        matching: &MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let matched = match_regions(source, target, matching, progress)?;
        let mut found = Self {
            are_automatic: true,
            ..Self::default()
        };
        if warp == WarpKind::Lines {
            let rings = matched.automatic_pins(AUTOMATIC_LINES);
            found.lines = rings.iter().flat_map(|ring| sides(ring)).collect();
        } else {
            found.points = matched.automatic_pins(AUTOMATIC_PINS).concat();
        }
        found.notes.extend(TransitionNote::of_match(&matched));
        found.matched = Some(matched);
        Ok(found)
    }

    /// Adds the match of the outlines on which the features lie, or a note if the outlines cannot
    /// be matched.
    ///
    /// # Errors
    /// If the work is cancelled.
    fn with_match(
        mut self,
        [source, target]: &[Regions; 2],
        matching: &MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        // A cancellation also makes the match fail. The checkpoint below returns it as a
        // cancellation, not as outlines that cannot be matched.
        let matched = match_regions(source, target, matching, progress);
        checkpoint(progress, "matching", 0.5)?;
        match matched {
            Ok(matched) => {
                self.notes.extend(TransitionNote::of_match(&matched));
                self.matched = Some(matched);
            }
            Err(error) => self.notes.push(TransitionNote::PinsUnmatched(error)),
        }
        Ok(self)
    }

    /// Returns the point features and, for each line feature, its two ends and its middle.
    pub fn as_points(&self) -> Vec<PointPair> {
        let points_on = |line: &LinePair| [0.0, 0.5, 1.0].map(|along| point_on_line(line, along));
        let line_points = self.lines.iter().flat_map(points_on);
        self.points.iter().copied().chain(line_points).collect()
    }

    /// Returns the points and the starting points of the lines if the features are automatic, so
    /// that they can be shown as pins; otherwise an empty list.
    pub fn automatic(&self) -> Vec<PointPair> {
        if !self.are_automatic {
            return Vec::new();
        }
        let starts = self.lines.iter().map(|line| point_on_line(line, 0.0));
        self.points.iter().copied().chain(starts).collect()
    }

    /// Returns whether all features are points that lie on the outlines of both designs.
    fn are_on(&self, outlines: &[Regions; 2]) -> bool {
        let is_on = |pair: &PointPair| {
            Side::BOTH.iter().all(|&side| {
                let regions = &outlines[side];
                let distance = |ring: &Ring| ring.distance_squared(pair[side]).sqrt();
                let nearest = regions.rings().map(distance).fold(f64::INFINITY, f64::min);
                nearest <= ON_OUTLINE_DISTANCE * regions.bounds().diameter()
            })
        };
        self.lines.is_empty() && self.points.iter().all(is_on)
    }
}

/// Returns the point at a fraction of a line, from 0 at its beginning to 1 at its end.
fn point_on_line(line: &LinePair, along: f64) -> PointPair {
    PointPair {
        source: line.source[0].lerp(line.source[1], along),
        target: line.target[0].lerp(line.target[1], along),
    }
}

/// Returns the lines from each pin of a closed list to the next; the last line ends at the first
/// pin.
fn sides(ring: &[PointPair]) -> impl Iterator<Item = LinePair> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| LinePair {
        source: [a.source, b.source],
        target: [a.target, b.target],
    })
}
