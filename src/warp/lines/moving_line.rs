//! Where a line is at t, between its two.
//!
//! Beier, Neely (1992), §3.3, by the ends or by middle, angle and length.
//!
//! Guaranteed: at t = 0 and t = 1 the line of the design to the last bit; the
//! pair exchanged is at 1 − t where the pair is at t, to rounding. A turn by π
//! goes the way on which the line halfway points to one fixed side, so that
//! neither rounding nor an exchange chooses. Beyond [0, 1] a line that shrinks
//! stays a point when it has become one (by middle, angle and length).

use super::line::LineEnds;
use super::options::LineInterpolation;
use crate::geometry::DVec2;
use std::f64::consts::TAU;

/// How far from π, as the sine, a turn is still one by π. Lines drawn against
/// each other and then laid into the frame by a similarity are off by 1e-15.
const NEARLY_HALF_A_TURN: f64 = 1e-9;

/// Where a line points halfway on a turn by π: up, and for lines that stand
/// upright, to the right. No usual direction is at right angles to it.
const HALFWAY: DVec2 = DVec2::new(0.123, 1.0);

/// A line on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingLine {
    pub(super) source: LineEnds,
    pub(super) target: LineEnds,
    /// The direction in the source, or that in the target if it has none.
    direction: DVec2,
    lengths: [f64; 2],
    /// From source to target, in radians, counter-clockwise.
    turn: f64,
}

impl MovingLine {
    pub(super) fn new(source: LineEnds, target: LineEnds) -> Self {
        let [(first, from), (last, to)] = [source, target].map(polar);
        let (direction, turn) = match (first, last) {
            (Some(first), Some(last)) => (first, turn(first, last)),
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

    /// Whether it has no length in either design.
    pub(super) fn is_point(&self) -> bool {
        self.lengths == [0.0; 2]
    }

    pub(super) fn at(&self, t: f64, between: LineInterpolation) -> LineEnds {
        // By middle, angle and length the ends would be met to rounding only.
        if t == 0.0 {
            return self.source;
        }
        if t == 1.0 {
            return self.target;
        }
        let between_points = |a: DVec2, b: DVec2| a * (1.0 - t) + b * t;
        let ([a, b], [c, d]) = (self.source, self.target);
        match between {
            LineInterpolation::Ends => [between_points(a, c), between_points(b, d)],
            LineInterpolation::MiddleAndAngle => {
                let middle = between_points(a.midpoint(b), c.midpoint(d));
                let length = (self.lengths[0] * (1.0 - t) + self.lengths[1] * t).max(0.0);
                let turned = DVec2::from_angle(t * self.turn).rotate(self.direction);
                let half = turned * (0.5 * length);
                [middle - half, middle + half]
            }
        }
    }
}

/// Direction, if there is one, and length.
fn polar([from, to]: LineEnds) -> (Option<DVec2>, f64) {
    let along = to - from;
    let length = along.x.hypot(along.y);
    // The reciprocal of a tiny length would overflow.
    let direction = (length > 0.0).then(|| along / length);
    (direction.filter(|d| d.is_finite()), length)
}

/// The angle from one direction to another, the shorter way.
fn turn(first: DVec2, last: DVec2) -> f64 {
    let (sine, cosine) = (first.perp_dot(last), first.dot(last));
    let turn = sine.atan2(cosine);
    // A turn by nearly ±π has a sign that rounding chose.
    if cosine > 0.0 || sine.abs() > NEARLY_HALF_A_TURN {
        return turn;
    }
    // Turning counter-clockwise, the line points this way halfway.
    let halfway = (first - last).perp();
    let counter_clockwise = halfway.dot(HALFWAY) > 0.0;
    match (counter_clockwise, turn > 0.0) {
        (true, false) => turn + TAU,
        (false, true) => turn - TAU,
        _ => turn,
    }
}
