//! The rigid motion that the features of two designs have in common.
//!
//! Guaranteed: exchanging the designs turns the motion back, to rounding,
//! unless it turns by π, which goes counter-clockwise either way.

use crate::correspondence::{LinePair, PointPair, RegionMatch};
use crate::geometry::{Bounds, DVec2};
use crate::settings::choice::named;

/// How the features of a warp of the plane travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FeatureTravel {
    /// As a whole where fields are seen; straight where pictures are, whose
    /// borders would turn into the frame.
    #[default]
    Auto,
    /// The rigid motion that they have in common is played as one, and only
    /// the rest goes straight.
    Whole,
    /// Each goes straight.
    Straight,
}

named! { FeatureTravel {
    Auto: "auto", "Auto", "As a whole where fields are seen, straight where pictures are.";
    Whole: "whole", "As a whole",
        "What turns keeps its size on the way; the borders of pictures turn too.";
    Straight: "straight", "Straight",
        "Each goes the shortest way; what turns far shrinks on the way.";
} }

/// The rigid motion that lays features of the source onto those of the target
/// best, in the sense of least squares: about one centre onto another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonRigidMotion {
    /// The mean of the features, in the source and in the target.
    pub(super) centres: [DVec2; 2],
    /// From source to target, in radians, counter-clockwise, in (−π, π].
    pub(super) turn: f64,
}

/// At so many steps a motion is looked at.
/// At most 12° a step, between which a corner bulges by half a percent of its
/// distance.
const SWEPT: u32 = 16;

/// Features whose turns cancel to less than this share have none in common.
const NO_TURN: f64 = 1e-9;

/// Turns so near π are π: rounding must not choose the way around.
const HALF_A_TURN: f64 = 1e-9;

impl CommonRigidMotion {
    /// The best motion for some features, a line counting as its two ends;
    /// none where there are fewer than two places or one is not finite.
    ///
    /// ```
    /// use morphospace::{correspondence::PointPair, geometry::DVec2, warp::RigidPart};
    /// let pair = |x, y| PointPair {
    ///     source: DVec2::new(x, y),
    ///     target: DVec2::new(x, y).perp(),
    /// };
    /// let turned = RigidPart::of(&[pair(0.0, 0.0), pair(1.0, 0.0)], &[]).expect("two points");
    /// assert!((turned.turn() - 0.5 * std::f64::consts::PI).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn of(points: &[PointPair], lines: &[LinePair]) -> Option<Self> {
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
        // Written so that NaN is refused too: no features give a mean of 0 / 0.
        if !(sum.is_finite() && sum.length() > NO_TURN * size) {
            return None;
        }
        let turn = sum.to_angle();
        let is_half = std::f64::consts::PI - turn.abs() < HALF_A_TURN;
        Some(Self {
            centres,
            turn: if is_half { turn.abs() } else { turn },
        })
    }

    /// The rotation from source to target, in radians, in (−π, π].
    #[must_use]
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// The rotation from the frame at `t` to rest, and the centre then.
    pub(super) fn at(&self, t: f64) -> (DVec2, DVec2) {
        // At rest is halfway: +½ of the turn away at t = 0, −½ at t = 1.
        let back = DVec2::from_angle((0.5 - t) * self.turn);
        (back, self.centres[0] * (1.0 - t) + self.centres[1] * t)
    }

    /// A match as it would be had nothing moved or turned.
    #[must_use]
    pub fn match_at_rest(&self, matched: &RegionMatch) -> RegionMatch {
        let mut matched = matched.clone();
        for ring in matched.pieces.iter_mut().flat_map(|piece| &mut piece.rings) {
            for (p, q) in ring.source.iter_mut().zip(&mut ring.target) {
                [*p, *q] = self.at_rest(*p, *q);
            }
        }
        matched
    }

    /// A frame of the same size where `frame` is at rest, so that options that
    /// count in frames keep their meaning.
    #[must_use]
    pub fn frame_at_rest(&self, frame: &Bounds) -> Bounds {
        let [a, b] = self.at_rest(frame.centre(), frame.centre());
        let half = 0.5 * frame.size();
        Bounds {
            min: a.midpoint(b) - half,
            max: a.midpoint(b) + half,
        }
    }

    /// The box around all places that the motion leads the frame of either
    /// design through, nearly.
    #[must_use]
    pub fn swept(&self, frame: &Bounds) -> Bounds {
        let mut swept = *frame;
        // The frame as either design has it at rest.
        for k in 0..=SWEPT {
            let t = f64::from(k) / f64::from(SWEPT);
            let (back, centre) = self.at(t);
            for corner in frame.corners() {
                for rest in self.at_rest(corner, corner) {
                    swept = swept.union(&Bounds::at(conjugate(back).rotate(rest) + centre));
                }
            }
        }
        swept
    }

    /// Leads places from rest back into the source and into the target.
    pub(super) fn maps_from_rest(&self) -> [impl Fn(DVec2) -> DVec2; 2] {
        let half = DVec2::from_angle(0.5 * self.turn);
        let [source, target] = self.centres;
        [(conjugate(half), source), (half, target)]
            .map(|(turn, centre)| move |p: DVec2| turn.rotate(p) + centre)
    }

    /// The features as they would be had nothing moved or turned: both about
    /// the origin, the target turned back by half and the source on by half.
    pub(super) fn at_rest(&self, source: DVec2, target: DVec2) -> [DVec2; 2] {
        let half = DVec2::from_angle(0.5 * self.turn);
        [
            half.rotate(source - self.centres[0]),
            conjugate(half).rotate(target - self.centres[1]),
        ]
    }
}

/// The rotation back.
pub(super) fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_without_a_direction_have_no_rigid_part() {
        let pair = |x: f64, y: f64| PointPair {
            source: DVec2::splat(x),
            target: DVec2::splat(y),
        };
        assert_eq!(CommonRigidMotion::of(&[], &[]), None);
        assert_eq!(CommonRigidMotion::of(&[pair(1.0, 2.0)], &[]), None);
        assert_eq!(
            CommonRigidMotion::of(&[pair(1.0, f64::NAN), pair(0.0, 1.0)], &[]),
            None
        );
    }
}
