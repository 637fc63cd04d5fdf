//! Point features of the scattered-point and lattice warps.
//!
//! Every feature moves on the straight line from its source to its target position. Line pairs are
//! replaced by sample points, so that lines drawn for the line warp also control these warps. The
//! line warp uses only the check for finite coordinates ([`check`]).

use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};

/// Number of points that represent a line: both ends and three evenly spaced between them
/// (heuristic).
pub const LINE_SAMPLES: usize = 5;

/// Maximum number of features, where a line counts as [`LINE_SAMPLES`] (resource limit: the
/// scattered-point warp solves a dense system of this size for every film frame).
pub const MAX_FEATURES: usize = 512;

/// Limit of each coordinate of a feature, relative to the frame's centre and in frame diameters.
/// Also the limit of |t|. Larger values are clamped (tolerance: squared coordinates must not
/// overflow).
const MAX_DISTANCE: f64 = 1e6;

/// Reason why features are rejected.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FeatureError {
    /// A coordinate of the frame or its diameter is not finite.
    #[error("the frame is not finite: give the designs finite coordinates")]
    Frame,
    /// A coordinate of a point pair is not finite. Holds the number of the pair, counted from 1.
    #[error("point pair {0}: a coordinate is not finite; move or delete the pair")]
    Point(usize),
    /// A coordinate of a line pair is not finite. Holds the number of the pair, counted from 1.
    #[error("line pair {0}: a coordinate is not finite; move or delete the pair")]
    Line(usize),
    /// There are more than [`MAX_FEATURES`] features.
    #[error(
        "{found} features (a line counts as {LINE_SAMPLES}), but at most {MAX_FEATURES} are possible; delete some"
    )]
    TooMany {
        /// Number of features given.
        found: usize,
    },
}

/// Validated point pairs, including the samples of lines.
#[derive(Clone, Debug)]
pub(super) struct WarpFeatures {
    pairs: Vec<PointPair>,
    /// Diameter of the frame, or 1 if that is zero.
    pub(super) unit: f64,
}

impl WarpFeatures {
    /// Validates the pairs and samples the lines.
    ///
    /// # Errors
    /// [`FeatureError`] if a coordinate is not finite or there are too many features.
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
        // Distant pins are clamped, not rejected: a pin dragged off the screen is no error.
        let centre = frame.centre();
        let clamp_point =
            |p: DVec2| p.clamp(centre - MAX_DISTANCE * unit, centre + MAX_DISTANCE * unit);
        let pairs = points
            .iter()
            .copied()
            .chain(lines.iter().flat_map(sample_line));
        let clamp_pair = |pair: PointPair| PointPair {
            source: clamp_point(pair.source),
            target: clamp_point(pair.target),
        };
        Ok(Self {
            pairs: pairs.map(clamp_pair).collect(),
            unit,
        })
    }

    /// For each feature, returns its position in the frame at t, and the displacements from there
    /// to its positions in the source and in the target.
    ///
    /// The source displacement is exactly zero at t = 0, the target displacement at t = 1.
    pub(super) fn at(&self, t: f64) -> impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone {
        // Without the clamp, the interpolated position could be infinite.
        let t = if t.is_nan() {
            0.0
        } else {
            t.clamp(-MAX_DISTANCE, MAX_DISTANCE)
        };
        self.pairs.iter().map(move |pair| {
            let at = pair.source * (1.0 - t) + pair.target * t;
            (at, [pair.source - at, pair.target - at])
        })
    }
}

/// Checks that all coordinates are finite.
///
/// # Errors
/// [`FeatureError`] with the number of the first pair that has a coordinate that is not finite.
pub(super) fn check(points: &[PointPair], lines: &[LinePair]) -> Result<(), FeatureError> {
    let is_bad_point = |p: &PointPair| !(p.source.is_finite() && p.target.is_finite());
    if let Some(index) = points.iter().position(is_bad_point) {
        return Err(FeatureError::Point(index + 1));
    }
    let is_bad_line = |l: &LinePair| !l.source.iter().chain(&l.target).all(|p| p.is_finite());
    if let Some(index) = lines.iter().position(is_bad_line) {
        return Err(FeatureError::Line(index + 1));
    }
    Ok(())
}

/// Returns [`LINE_SAMPLES`] evenly spaced point pairs along a line pair.
fn sample_line(line: &LinePair) -> impl Iterator<Item = PointPair> + '_ {
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
        let expected = [0.0, 0.25, 0.5, 0.75, 1.0].map(|x| DVec2::new(x, 0.5));
        assert_eq!(halfway, expected);
        let far = PointPair {
            source: DVec2::ZERO,
            target: DVec2::X * 1e9,
        };
        let features = WarpFeatures::new(&frame, &[far], &[line])?;
        let positions: Vec<_> = features.at(1.0).map(|(at, _)| at).collect();
        // Only features far outside the frame are clamped.
        assert!(positions[0] != far.target && positions[0].is_finite());
        assert_eq!(positions[1], line.target[0]);
        Ok(())
    }
}
