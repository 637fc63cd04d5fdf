//! Interpolation of a line pair at t: by its end points, or by midpoint, angle and length.
//!
//! Both variants are in Beier, Neely (1992), §3.3.
//!
//! Guaranteed: at t = 0 the line is exactly that of the source, at t = 1 exactly that of the
//! target. Exchanging the designs mirrors the motion in time, up to rounding. A line that rotates
//! by π points to a fixed side halfway, so that neither rounding nor an exchange of the designs
//! changes the direction of rotation. Outside [0, 1], a length that reaches zero stays zero.

use super::line::LineEnds;
use super::options::LineInterpolation;
use crate::geometry::DVec2;
use std::f64::consts::TAU;

/// An angle near ±π counts as π if the absolute value of its sine is at most this value (tolerance:
/// antiparallel lines transformed by a similarity are off by about 1e-15).
const HALF_TURN_TOLERANCE: f64 = 1e-9;

/// Halfway through a rotation by π, a line is perpendicular to its start. Of the two perpendicular
/// directions, it takes the one with a positive component along this vector: up, and for upright
/// lines to the right. The vector is slightly tilted, so that no common direction is perpendicular
/// to it.
const HALFWAY_DIRECTION: DVec2 = DVec2::new(0.123, 1.0);

/// A line pair prepared for interpolation.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingLine {
    pub(super) source: LineEnds,
    pub(super) target: LineEnds,
    /// Unit direction in the source, or in the target if the source line is a point.
    direction: DVec2,
    /// Length in source and target.
    lengths: [f64; 2],
    /// Rotation from source to target in radians, counter-clockwise.
    turn: f64,
}

impl MovingLine {
    pub(super) fn new(source: LineEnds, target: LineEnds) -> Self {
        let [(first, from), (last, to)] = [source, target].map(polar);
        let (direction, turn) = match (first, last) {
            (Some(first), Some(last)) => (first, smaller_angle(first, last)),
            (first, last) => (first.or(last).unwrap_or(DVec2::X), 0.0),
        };
        Self {
            source,
            target,
            direction,
            lengths: [from, to],
            turn,
        }
    }

    /// Returns whether the line has zero length in both designs.
    pub(super) fn is_point(&self) -> bool {
        self.lengths == [0.0; 2]
    }

    /// Returns the line's end points at t.
    pub(super) fn at(&self, t: f64, between: LineInterpolation) -> LineEnds {
        // Interpolating midpoint, angle and length would reproduce the ends only up to rounding.
        if t == 0.0 {
            return self.source;
        }
        if t == 1.0 {
            return self.target;
        }
        let lerp = |a: DVec2, b: DVec2| a * (1.0 - t) + b * t;
        let ([a, b], [c, d]) = (self.source, self.target);
        match between {
            LineInterpolation::Ends => [lerp(a, c), lerp(b, d)],
            LineInterpolation::MiddleAndAngle => {
                let middle = lerp(a.midpoint(b), c.midpoint(d));
                let length = (self.lengths[0] * (1.0 - t) + self.lengths[1] * t).max(0.0);
                let turned = DVec2::from_angle(t * self.turn).rotate(self.direction);
                let half = turned * (0.5 * length);
                [middle - half, middle + half]
            }
        }
    }
}

/// Returns the unit direction of a line (`None` for a point) and its length.
fn polar([from, to]: LineEnds) -> (Option<DVec2>, f64) {
    let along = to - from;
    let length = along.x.hypot(along.y);
    // Divides, because the reciprocal of a tiny length would overflow.
    let direction = (length > 0.0).then(|| along / length);
    (direction.filter(|d| d.is_finite()), length)
}

/// Of the two rotations from the direction `first` to the direction `last`, returns the one with
/// the smaller angle, in radians, positive if counter-clockwise.
fn smaller_angle(first: DVec2, last: DVec2) -> f64 {
    let (sine, cosine) = (first.perp_dot(last), first.dot(last));
    let turn = sine.atan2(cosine);
    // Near ±π the sign depends on rounding; it is chosen below.
    if cosine > 0.0 || sine.abs() > HALF_TURN_TOLERANCE {
        return turn;
    }
    // Direction of the line halfway through a counter-clockwise rotation.
    let halfway = (first - last).perp();
    let is_counter_clockwise = halfway.dot(HALFWAY_DIRECTION) > 0.0;
    match (is_counter_clockwise, turn > 0.0) {
        (true, false) => turn + TAU,
        (false, true) => turn - TAU,
        _ => turn,
    }
}
