//! When a part grows from a point, or shrinks to one.
//!
//! A part that one design has alone is a speck in the other. It moves with the
//! whole from the first frame to the last like every other part, but grows and
//! goes its own way within a time of its own: what is born waits until its
//! place is free, and what dies is gone before others come. Beyond the film it
//! is as it is at its end.

use serde::{Deserialize, Serialize};

/// The time in which a part changes its size and place from one end to the
/// other, within [0, 1]. Before and after it keeps those of that end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Life {
    /// When it begins to change.
    pub from: f64,
    /// When it has changed, later than that.
    pub to: f64,
}

impl Life {
    /// All of the film.
    pub const WHOLE: Self = Self { from: 0.0, to: 1.0 };

    /// Whether it is a time within the film.
    pub(crate) fn is_sound(&self) -> bool {
        0.0 <= self.from && self.from < self.to && self.to <= 1.0
    }

    /// How much of the change is done at `t`: exactly 0 and 1 at the ends, and
    /// beyond them, so that nothing turns over there.
    ///
    /// ```
    /// use morphospace::warp::Life;
    /// let late = Life { from: 0.5, to: 1.0 };
    /// assert_eq!([0.0, 0.4, 0.75, 1.0].map(|t| late.share(t)), [0.0, 0.0, 0.5, 1.0]);
    /// assert_eq!(late.backwards().share(0.25), 0.5);
    /// ```
    #[must_use]
    pub fn share(self, t: f64) -> f64 {
        ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// The same in the film that is run backwards.
    #[must_use]
    pub fn backwards(self) -> Self {
        Self {
            from: 1.0 - self.to,
            to: 1.0 - self.from,
        }
    }
}
