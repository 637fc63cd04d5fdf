//! Part timings: time windows of single parts, in which these parts move.
//!
//! A part is identified by a point of a design. The timing applies to the whole motion of the part;
//! if the part is split, to each of its pieces.

use crate::geometry::{DVec2, RANGE_MESSAGE, Side, Similarity, is_in_range};
use crate::time::EasingFunction;
use crate::warp::PartClock;
use serde::{Deserialize, Serialize};

/// The time window in which a part moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PartTime {
    /// The design to which the point belongs.
    pub side: Side,
    /// A point in or near the part: in the design's own coordinates in a document, in those of the
    /// common frame in a specification.
    pub at: DVec2,
    /// t at which the part starts, at least 0.
    #[serde(default)]
    pub from: f64,
    /// t at which the part arrives, greater than `from` and at most 1.
    #[serde(default = "one")]
    pub to: f64,
    /// Easing of the motion between `from` and `to`.
    #[serde(default)]
    pub easing: EasingFunction,
}

/// Maximum number of part timings (resource limit: several times the maximum number of matched
/// parts).
const MAX_PART_TIMES: usize = 2000;

fn one() -> f64 {
    1.0
}

/// Reason why a part timing is invalid. Variants hold indices from 0; messages count from 1.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartTimeError {
    /// There are more timings than the maximum. Holds their number.
    #[error("{0} part timings are too many; the maximum is {MAX_PART_TIMES}")]
    TooMany(usize),
    /// The coordinates of a point are out of range. Holds the index of its timing.
    #[error("the point of part timing {} {RANGE_MESSAGE}", .0 + 1)]
    Place(usize),
    /// The part does not start before it arrives, or one of the two times is outside [0, 1].
    #[error(
        "a part cannot move from t = {from} to t = {to}; give two numbers from 0 to 1, the smaller one first"
    )]
    Span {
        /// The requested start.
        from: f64,
        /// The requested arrival.
        to: f64,
    },
}

impl PartTime {
    /// Checks that all points and times are valid.
    ///
    /// # Errors
    /// [`PartTimeError`] for the first invalid timing.
    pub fn check(all: &[Self]) -> Result<(), PartTimeError> {
        if all.len() > MAX_PART_TIMES {
            return Err(PartTimeError::TooMany(all.len()));
        }
        for (k, &Self { at, from, to, .. }) in all.iter().enumerate() {
            if !is_in_range(at) {
                return Err(PartTimeError::Place(k));
            }
            if !(0.0 <= from && from < to && to <= 1.0) {
                return Err(PartTimeError::Span { from, to });
            }
        }
        Ok(())
    }

    /// Returns the clock of the part, that is, its time window and easing.
    #[must_use]
    pub fn clock(&self) -> PartClock {
        let Self {
            from, to, easing, ..
        } = *self;
        PartClock { from, to, easing }
    }

    /// Returns the timing with the time window and easing of a clock.
    #[must_use]
    pub fn with_clock(self, PartClock { from, to, easing }: PartClock) -> Self {
        Self {
            from,
            to,
            easing,
            ..self
        }
    }

    /// Returns the timing with its point transformed by the similarity of its design.
    #[must_use]
    pub fn placed(&self, by: &[Similarity; 2]) -> Self {
        Self {
            at: by[self.side].apply(self.at),
            ..*self
        }
    }

    /// Returns the timing for the exchanged designs, whose motion runs backwards.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..self.with_clock(self.clock().backwards())
        }
    }
}
