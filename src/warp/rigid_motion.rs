//! The rigid motion common to all features, split off before a plane warp is built.
//!
//! The motion translates the source features such that their centroid lies at the centroid of the
//! target features. It rotates them about this point such that they fit the target features best in
//! the least-squares sense (two-dimensional Procrustes problem). The remaining, elastic
//! displacement is expressed "at rest": in coordinates in which both designs are centred and
//! rotated to the halfway angle.
//!
//! Guaranteed: exchanging the designs inverts the motion up to rounding, except that a rotation by
//! π is counter-clockwise in both directions.

use crate::correspondence::{LinePair, PointPair, RegionMatch};
use crate::geometry::{Bounds, DVec2};
use crate::settings::named;

/// Motion of the features of a plane warp between the designs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FeatureTravel {
    /// [`Self::Whole`] for fields and [`Self::Straight`] for pictures, whose borders would
    /// otherwise rotate into the frame.
    #[default]
    Auto,
    /// The common rigid motion is applied as a rotation; only the remaining displacement is
    /// interpolated linearly.
    Whole,
    /// Every feature moves on a straight line.
    Straight,
}

named! { FeatureTravel {
    Auto: "auto", "Auto", "Rotate together for fields, move straight for pictures.";
    Whole: "whole", "Rotate together",
        "Rotating shapes keep their size; the borders of pictures rotate too.";
    Straight: "straight", "Straight",
        "Features move on straight lines; shapes that rotate far shrink in between.";
} }

/// Best rigid motion of the source features onto the target features (least squares).
///
/// It rotates about the source centroid and moves that centroid to the target centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonRigidMotion {
    /// Centroid of the features in the source and in the target.
    pub(super) centres: [DVec2; 2],
    /// Rotation from source to target in radians, counter-clockwise, in (−π, π].
    pub(super) turn: f64,
}

/// Number of intervals between the times at which [`CommonRigidMotion::swept_bounds`] samples the
/// motion.
///
/// Derived: the frame rotates by at most 12° in an interval, and the arc of a corner between two
/// samples bulges by at most half a percent of the corner's distance from the centre.
const SWEEP_STEPS: u32 = 16;

/// Length of the summed rotation vectors, relative to the sum of their lengths, below which the sum
/// has no direction (tolerance: rounding of a sum that cancels).
const NO_TURN: f64 = 1e-9;

/// Difference from π in radians below which a rotation counts as π (tolerance: rounding must
/// not choose the direction).
const HALF_TURN_TOLERANCE: f64 = 1e-9;

impl CommonRigidMotion {
    /// Fits the motion to features; a line counts as its two ends.
    ///
    /// Returns `None` if the features leave the rotation undetermined (fewer than two distinct
    /// points) or a coordinate is not finite.
    ///
    /// ```
    /// use morphospace::{correspondence::PointPair, geometry::DVec2, warp::CommonRigidMotion};
    /// let pair = |x, y| PointPair {
    ///     source: DVec2::new(x, y),
    ///     target: DVec2::new(x, y).perp(),
    /// };
    /// let pairs = [pair(0.0, 0.0), pair(1.0, 0.0)];
    /// let turned = CommonRigidMotion::fit(&pairs, &[]).expect("two points");
    /// assert!((turned.turn() - 0.5 * std::f64::consts::PI).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn fit(points: &[PointPair], lines: &[LinePair]) -> Option<Self> {
        let ends = |line: &LinePair| {
            [0, 1].map(|k| PointPair {
                source: line.source[k],
                target: line.target[k],
            })
        };
        let pairs: Vec<PointPair> = (points.iter().copied())
            .chain(lines.iter().flat_map(ends))
            .collect();
        let count = pairs.len() as f64;
        let mean = |of: fn(&PointPair) -> DVec2| pairs.iter().map(of).sum::<DVec2>() / count;
        let centres = [mean(|p| p.source), mean(|p| p.target)];
        let (mut sum, mut size) = (DVec2::ZERO, 0.0);
        for pair in &pairs {
            let (p, q) = (pair.source - centres[0], pair.target - centres[1]);
            sum += DVec2::new(p.dot(q), p.perp_dot(q));
            size += p.length() * q.length();
        }
        // The negated comparison also rejects NaN: without features the mean is 0 / 0.
        if !(sum.is_finite() && sum.length() > NO_TURN * size) {
            return None;
        }
        let turn = sum.to_angle();
        let is_half_turn = std::f64::consts::PI - turn.abs() < HALF_TURN_TOLERANCE;
        Some(Self {
            centres,
            turn: if is_half_turn { turn.abs() } else { turn },
        })
    }

    /// Returns the rotation from source to target in radians, in (−π, π].
    #[must_use]
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// Returns the rotation from the frame at `t` to rest coordinates, as a unit complex number,
    /// and the position in the frame of the centroid at `t`.
    pub(super) fn at(&self, t: f64) -> (DVec2, DVec2) {
        // Rest coordinates have the halfway angle: they are rotated by +½ `turn` at t = 0 and by −½
        // `turn` at t = 1.
        let back = DVec2::from_angle((0.5 - t) * self.turn);
        (back, self.centres[0] * (1.0 - t) + self.centres[1] * t)
    }

    /// Returns the boundary match with all points in rest coordinates, in which both designs are
    /// centred and rotated to the halfway angle.
    #[must_use]
    pub fn match_to_rest(&self, matched: &RegionMatch) -> RegionMatch {
        let mut matched = matched.clone();
        for ring in matched.pieces.iter_mut().flat_map(|piece| &mut piece.rings) {
            for (p, q) in ring.source.iter_mut().zip(&mut ring.target) {
                [*p, *q] = self.rest_positions(*p, *q);
            }
        }
        matched
    }

    /// Returns a frame of the same size in rest coordinates. The centre of `frame` has two images
    /// there, one as a point of the source and one as a point of the target; the new frame is
    /// centred at their mean.
    ///
    /// The size is unchanged because options are relative to the frame's size.
    #[must_use]
    pub fn frame_to_rest(&self, frame: &Bounds) -> Bounds {
        let [a, b] = self.rest_positions(frame.centre(), frame.centre());
        let half = 0.5 * frame.size();
        Bounds {
            min: a.midpoint(b) - half,
            max: a.midpoint(b) + half,
        }
    }

    /// Returns the bounding box of the area that `frame` sweeps when it moves rigidly with the
    /// source and when it moves rigidly with the target.
    ///
    /// The motion is sampled, so the box may be too small by about half a percent.
    #[must_use]
    pub fn swept_bounds(&self, frame: &Bounds) -> Bounds {
        let mut swept = *frame;
        for k in 0..=SWEEP_STEPS {
            let t = f64::from(k) / f64::from(SWEEP_STEPS);
            let (back, centre) = self.at(t);
            for corner in frame.corners() {
                for rest in self.rest_positions(corner, corner) {
                    swept = swept.union(&Bounds::at(conjugate(back).rotate(rest) + centre));
                }
            }
        }
        swept
    }

    /// Returns two mappings from rest coordinates (in which both designs are centred and rotated to
    /// the halfway angle): one to the source and one to the target.
    pub(super) fn maps_from_rest(&self) -> [impl Fn(DVec2) -> DVec2; 2] {
        let half = DVec2::from_angle(0.5 * self.turn);
        let [source, target] = self.centres;
        [(conjugate(half), source), (half, target)]
            .map(|(turn, centre)| move |p: DVec2| turn.rotate(p) + centre)
    }

    /// Converts a source point and a target point to rest coordinates.
    ///
    /// Both are centred on the origin; the source is rotated forwards by half the turn and the
    /// target backwards by half.
    pub(super) fn rest_positions(&self, source: DVec2, target: DVec2) -> [DVec2; 2] {
        let half = DVec2::from_angle(0.5 * self.turn);
        [
            half.rotate(source - self.centres[0]),
            conjugate(half).rotate(target - self.centres[1]),
        ]
    }
}

/// Returns the inverse of a rotation given as a unit complex number.
pub(super) fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_without_a_direction_have_no_rigid_motion() {
        let pair = |x: f64, y: f64| PointPair {
            source: DVec2::splat(x),
            target: DVec2::splat(y),
        };
        assert_eq!(CommonRigidMotion::fit(&[], &[]), None);
        assert_eq!(CommonRigidMotion::fit(&[pair(1.0, 2.0)], &[]), None);
        assert_eq!(
            CommonRigidMotion::fit(&[pair(1.0, f64::NAN), pair(0.0, 1.0)], &[]),
            None
        );
    }
}
