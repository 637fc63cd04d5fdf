//! Time window in which a transient part grows from a point or shrinks to one.
//!
//! A part that exists in only one design is a tiny seed shape in the other. It moves with the whole
//! design from t = 0 to t = 1, like every other part, but changes its size, and its position
//! relative to the design, only within its time window. A part that appears can thus wait until its
//! place is free, and a part that disappears can make room in time. For t < 0 a part keeps its size
//! at t = 0, and for t > 1 its size at t = 1.

use crate::geometry::Side;
use serde::{Deserialize, Serialize};

/// Curvature of the size as a function of time: 0 means growth at constant speed, 1 a parabola
/// whose speed drops to zero at full size (heuristic).
const GROWTH_CURVATURE: f64 = 0.75;

/// Time window within [0, 1] in which a transient part changes its size and its position relative
/// to the design.
///
/// Before the time window the part has its size in the source, after it the size in the target. A
/// part that appears grows fast at first and slowly at last; a part that disappears shrinks in
/// reverse. The area thus changes almost linearly. If one part disappears while an equal one
/// appears, both together have 0.95 times the area of one halfway through the time window. With a
/// diameter that changes linearly, they would have only 0.5 times that area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeWindow {
    /// Design in which the part exists.
    pub side: Side,
    /// Time at which the change starts, at least 0.
    pub from: f64,
    /// Time at which the change ends, later than `from` and at most 1.
    pub to: f64,
}

impl TimeWindow {
    /// Returns the time window [0, 1] for a part that exists only in the given design.
    #[must_use]
    pub fn whole(side: Side) -> Self {
        Self {
            side,
            from: 0.0,
            to: 1.0,
        }
    }

    /// Returns whether the time window is a nonempty interval within [0, 1].
    pub(crate) fn is_valid(&self) -> bool {
        0.0 <= self.from && self.from < self.to && self.to <= 1.0
    }

    /// Returns the diameter of the part at `t`, relative to its diameter in the design in which it
    /// exists.
    ///
    /// The result is exactly 0 or 1 outside the time window, so that extrapolation cannot turn the
    /// part inside out.
    ///
    /// ```
    /// use morphospace::{geometry::Side, warp::TimeWindow};
    /// let late = TimeWindow { from: 0.5, ..TimeWindow::whole(Side::Target) };
    /// assert_eq!([0.0, 0.4, 1.0, 1.2].map(|t| late.size(t)), [0.0, 0.0, 1.0, 1.0]);
    /// // The area in the middle of the window.
    /// assert!((0.45..0.5).contains(&late.size(0.75).powi(2)));
    /// assert!((late.backwards().size(0.2) - late.size(0.8)).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn size(self, t: f64) -> f64 {
        let time = ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        let grown = match self.side {
            Side::Source => 1.0 - time,
            Side::Target => time,
        };
        grown * (1.0 + GROWTH_CURVATURE * (1.0 - grown))
    }

    /// Returns the completed fraction of the change of size at `t`: exactly 0 before the time
    /// window and exactly 1 after it.
    #[must_use]
    pub fn fraction_done(self, t: f64) -> f64 {
        match self.side {
            Side::Source => 1.0 - self.size(t),
            Side::Target => self.size(t),
        }
    }

    /// Returns the interval of transition times in which the part is visible.
    ///
    /// `when` maps a time on the part's own clock to the transition time.
    pub(crate) fn visible_interval(self, when: impl Fn(f64) -> f64) -> [f64; 2] {
        match self.side {
            Side::Source => [0.0, when(self.to)],
            Side::Target => [when(self.from), 1.0],
        }
    }

    /// Returns whether the part has zero size at `t`.
    #[must_use]
    pub fn is_absent(self, t: f64) -> bool {
        self.size(t) == 0.0
    }

    /// Returns the time window for the reversed motion.
    #[must_use]
    pub fn backwards(self) -> Self {
        Self {
            side: self.side.other(),
            from: 1.0 - self.to,
            to: 1.0 - self.from,
        }
    }
}
