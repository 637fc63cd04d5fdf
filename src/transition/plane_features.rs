//! What a warp of the plane goes by: pins and lines that were set, or found
//! along matched outlines.

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

/// Pins so near an outline are on it, as a share of the design's diameter.
/// A few pixels of a window: so far a hand misses that drags along a line.
const ON_OUTLINE: f64 = 0.005;

/// Pins that are set along each outline where nobody set any.
/// Each costs a row of the equations.
const AUTOMATIC: usize = 24;

/// The same of lines, each of which pulls the whole plane along: where many are
/// near each other it folds.
const AUTOMATIC_LINES: usize = 10;

/// What a warp of the plane goes by.
#[derive(Default)]
pub(super) struct PlaneFeatures {
    pub points: Vec<PointPair>,
    pub lines: Vec<LinePair>,
    /// Nobody set them.
    pub are_automatic: bool,
    /// The outlines that they are on, where all are on outlines.
    pub matched: Option<RegionMatch>,
    /// What was done otherwise than asked.
    pub notes: Vec<TransitionNote>,
}

impl PlaneFeatures {
    /// Those that were set; where there are none and outlines are what is
    /// seen, some along matched outlines.
    pub fn of(
        spec: &TransitionSpec,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let asked = &spec.options.matching;
        let given = Self {
            points: asked.pins.clone(),
            lines: asked.lines.clone(),
            ..Self::default()
        };
        // Outlines of a picture's form are not what is seen of it.
        if spec.cell.content() != ContentKind::Field {
            return Ok(given);
        }
        // No map of the plane cuts a ring open or a part in two.
        let matching = MatchSettings {
            holes: HoleRule::Close,
            parts: PartRule::Alone,
            ..asked.clone()
        };
        let outlines = spec.outlines(bar_width, progress)?;
        if given.points.is_empty() && given.lines.is_empty() {
            return Self::found(spec.cell.warp(), &outlines, &matching, progress);
        }
        // Pins that somebody moved along the outlines still match them.
        if spec.cell.warp() == WarpKind::Arap && given.are_on(&outlines) {
            return given.with_match(&outlines, &matching, progress);
        }
        Ok(given)
    }

    /// Some along matched outlines.
    fn found(
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
            found.points = matched.automatic_pins(AUTOMATIC).concat();
        }
        found.notes.extend(TransitionNote::of_match(&matched));
        found.matched = Some(matched);
        Ok(found)
    }

    /// With the match of the outlines that they are on, where there is one.
    fn with_match(
        mut self,
        [source, target]: &[Regions; 2],
        matching: &MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        // A cancel must not pass for outlines that do not match.
        let matched = match_regions(source, target, matching, progress);
        checkpoint(progress, "matching", 0.5)?;
        match matched {
            Ok(matched) => {
                self.notes.extend(TransitionNote::of_match(&matched));
                self.matched = Some(matched);
            }
            Err(error) => self.notes.push(TransitionNote::NotMatched(error)),
        }
        Ok(self)
    }

    /// Lines as their ends and their middle.
    pub fn as_points(&self) -> Vec<PointPair> {
        let of_line = |line: &LinePair| [0.0, 0.5, 1.0].map(|along| on(line, along));
        let ends = self.lines.iter().flat_map(of_line);
        self.points.iter().copied().chain(ends).collect()
    }

    /// Points and the beginnings of lines, where nobody set them.
    pub fn automatic(&self) -> Vec<PointPair> {
        if !self.are_automatic {
            return Vec::new();
        }
        let starts = self.lines.iter().map(|line| on(line, 0.0));
        self.points.iter().copied().chain(starts).collect()
    }

    /// Whether each feature is a point, and on the outline of either design.
    fn are_on(&self, outlines: &[Regions; 2]) -> bool {
        let is_on = |pair: &PointPair| {
            Side::BOTH.iter().all(|&side| {
                let regions = &outlines[side];
                let far = |ring: &Ring| ring.distance_squared(pair[side]).sqrt();
                let near = regions.rings().map(far).fold(f64::INFINITY, f64::min);
                near <= ON_OUTLINE * regions.bounds().diameter()
            })
        };
        self.lines.is_empty() && self.points.iter().all(is_on)
    }
}

/// A place along a line, 0 at its beginning and 1 at its end.
fn on(line: &LinePair, along: f64) -> PointPair {
    PointPair {
        source: line.source[0].lerp(line.source[1], along),
        target: line.target[0].lerp(line.target[1], along),
    }
}

/// The lines from each pin of a ring to the next.
fn sides(ring: &[PointPair]) -> impl Iterator<Item = LinePair> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| LinePair {
        source: [a.source, b.source],
        target: [a.target, b.target],
    })
}
