//! When a part grows from a point, or shrinks to one.
//!
//! A part that one design has alone is a speck in the other. It moves with the
//! whole from the first frame to the last like every other part, but grows and
//! goes its own way within a time of its own: what is born waits until its
//! place is free, and what dies is gone before others come. Beyond the film it
//! is as it is at its end.

use crate::geometry::Side;
use serde::{Deserialize, Serialize};

/// How much sooner than evenly it grows, from 0 to 1. With more, what lies against
/// something at its end nears it more slowly than that does, and they meet: as a quarter of a
/// sine one of 60 pairs of icons was not proved. Of those, and of 60 random other ones, the
/// worst tenth of the area up and down is 0.62 and 0.64 by 0, 0.51 and 0.40 by 0.5, 0.45 and
/// 0.39 by this; that of turning 0.32 and 0.42, 0.31 and 0.40, 0.33 and 0.35.
const SOONER: f64 = 0.75;

/// When what one design has alone changes its size and place from one end to the other,
/// within [0, 1]. Before and after it keeps those of that end.
///
/// It grows fast at first and slowly at last, and goes the same way backwards, so that its
/// area changes about as evenly as time: of two alike of which one goes as the other comes
/// both together enclose 0.95 of one halfway. By a size that changes evenly it would be half.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeWindow {
    /// The design that has it.
    pub side: Side,
    /// When it begins to change.
    pub from: f64,
    /// When it has changed, later than that.
    pub to: f64,
}

impl TimeWindow {
    /// All of the film.
    #[must_use]
    pub fn whole(side: Side) -> Self {
        Self {
            side,
            from: 0.0,
            to: 1.0,
        }
    }

    /// Whether it is a time within the film.
    pub(crate) fn is_sound(&self) -> bool {
        0.0 <= self.from && self.from < self.to && self.to <= 1.0
    }

    /// How large it is at `t`, across, as a share of what it is in its design: exactly 0 and
    /// 1 at the ends, and beyond them, so that nothing turns over there.
    ///
    /// ```
    /// use morphospace::{geometry::Side, warp::Life};
    /// let late = Life { from: 0.5, ..Life::whole(Side::Target) };
    /// assert_eq!([0.0, 0.4, 1.0, 1.2].map(|t| late.size(t)), [0.0, 0.0, 1.0, 1.0]);
    /// // Its area at half time.
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
        grown * (1.0 + SOONER * (1.0 - grown))
    }

    /// How much of the change is done at `t`, as exactly.
    #[must_use]
    pub fn share(self, t: f64) -> f64 {
        match self.side {
            Side::Source => 1.0 - self.size(t),
            Side::Target => self.size(t),
        }
    }

    /// From when to when within the film there is something of it, where a clock shows t
    /// `when` it says.
    pub(crate) fn there(self, when: impl Fn(f64) -> f64) -> [f64; 2] {
        match self.side {
            Side::Source => [0.0, when(self.to)],
            Side::Target => [when(self.from), 1.0],
        }
    }

    /// Whether there is nothing of it at `t`.
    #[must_use]
    pub fn is_gone(self, t: f64) -> bool {
        self.size(t) == 0.0
    }

    /// The same in the film that is run backwards.
    #[must_use]
    pub fn backwards(self) -> Self {
        Self {
            side: self.side.other(),
            from: 1.0 - self.to,
            to: 1.0 - self.from,
        }
    }
}
