//! The pairs of points that warps by points move by, and where they are at t:
//! on the straight line from the source's place to the target's.
//!
//! Lines count as rows of points, so that a person who switches from a warp by
//! lines loses no work.

use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};

/// How many points stand for a line: its ends, and evenly between.
pub const LINE_SAMPLES: usize = 5;

/// How many features a frame solves for: a line counts as
/// [`LINE_SAMPLES`].
pub const MAX_FEATURES: usize = 512;

/// Features farther from the frame than so many of its diameters, and times
/// beyond so many films, are taken to be there: squares must not overflow.
const FAR: f64 = 1e6;

/// Why features are none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FeatureError {
    /// The frame has no place or no size in numbers.
    #[error("the frame is not finite: give the designs finite coordinates")]
    Frame,
    /// A coordinate of a pair of points is infinite or not a number.
    #[error("pair of points {0}: a coordinate is not finite; move or delete the pair")]
    Point(usize),
    /// A coordinate of a pair of lines is infinite or not a number.
    #[error("pair of lines {0}: a coordinate is not finite; move or delete the pair")]
    Line(usize),
    /// More than a frame can solve for.
    #[error(
        "{found} features, a line counting as {LINE_SAMPLES}: at most {MAX_FEATURES} are moved by; delete some"
    )]
    TooMany {
        /// How many there are.
        found: usize,
    },
}

/// Checked pairs, with lines sampled.
#[derive(Clone, Debug)]
pub(super) struct WarpFeatures {
    pairs: Vec<PointPair>,
    /// The frame's diameter, or 1 if it has none.
    pub(super) unit: f64,
}

impl WarpFeatures {
    /// # Errors
    /// [`FeatureError`] on coordinates that are not finite, and on too many
    /// features. Pairs are counted from 1.
    pub(super) fn new(
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
    ) -> Result<Self, FeatureError> {
        let diameter = frame.diameter();
        if !(frame.min.is_finite() && frame.max.is_finite() && diameter.is_finite()) {
            return Err(FeatureError::Frame);
        }
        check(points, lines)?;
        let found = points.len() + LINE_SAMPLES * lines.len();
        if found > MAX_FEATURES {
            return Err(FeatureError::TooMany { found });
        }
        let unit = if diameter > 0.0 { diameter } else { 1.0 };
        // Held nearer, not refused: a pin dragged off the screen is no error.
        let centre = frame.centre();
        let near = |p: DVec2| p.clamp(centre - FAR * unit, centre + FAR * unit);
        let pairs = points.iter().copied().chain(lines.iter().flat_map(sampled));
        let nearer = |pair: PointPair| PointPair {
            source: near(pair.source),
            target: near(pair.target),
        };
        Ok(Self {
            pairs: pairs.map(nearer).collect(),
            unit,
        })
    }

    /// The features at t, and from there to the source and to the target. At
    /// t = 0 and t = 1 the one or the other is exactly zero.
    pub(super) fn at(&self, t: f64) -> impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone {
        // Beyond so many films as well, or (1 − t) p + t q would be infinite.
        let t = if t.is_nan() { 0.0 } else { t.clamp(-FAR, FAR) };
        self.pairs.iter().map(move |pair| {
            let at = pair.source * (1.0 - t) + pair.target * t;
            (at, [pair.source - at, pair.target - at])
        })
    }
}

/// That all coordinates are finite.
///
/// # Errors
/// [`FeatureError`] names the first pair that has others, counted from 1.
pub(super) fn check(points: &[PointPair], lines: &[LinePair]) -> Result<(), FeatureError> {
    let bad = |p: &PointPair| !(p.source.is_finite() && p.target.is_finite());
    if let Some(index) = points.iter().position(bad) {
        return Err(FeatureError::Point(index + 1));
    }
    let bad = |l: &LinePair| !l.source.iter().chain(&l.target).all(|p| p.is_finite());
    if let Some(index) = lines.iter().position(bad) {
        return Err(FeatureError::Line(index + 1));
    }
    Ok(())
}

fn sampled(line: &LinePair) -> impl Iterator<Item = PointPair> + '_ {
    (0..LINE_SAMPLES).map(|k| {
        let s = k as f64 / (LINE_SAMPLES - 1) as f64;
        let on = |[a, b]: [DVec2; 2]| a * (1.0 - s) + b * s;
        PointPair {
            source: on(line.source),
            target: on(line.target),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_sampled_from_end_to_end() -> Result<(), FeatureError> {
        let frame = Bounds {
            min: DVec2::ZERO,
            max: DVec2::ONE,
        };
        let line = LinePair {
            source: [DVec2::ZERO, DVec2::X],
            target: [DVec2::Y, DVec2::ONE],
        };
        let features = WarpFeatures::new(&frame, &[], &[line])?;
        let halfway: Vec<DVec2> = features.at(0.5).map(|(at, _)| at).collect();
        let wanted = [0.0, 0.25, 0.5, 0.75, 1.0].map(|x| DVec2::new(x, 0.5));
        assert_eq!(halfway, wanted);
        let far = PointPair {
            source: DVec2::ZERO,
            target: DVec2::X * 1e9,
        };
        let features = WarpFeatures::new(&frame, &[far], &[line])?;
        let places: Vec<_> = features.at(1.0).map(|(at, _)| at).collect();
        // What is far beyond the frame is held nearer; the rest stays.
        assert!(places[0] != far.target && places[0].is_finite());
        assert_eq!(places[1], line.target[0]);
        Ok(())
    }
}
