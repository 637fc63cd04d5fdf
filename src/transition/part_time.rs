//! Parts that make their way in their own time.
//!
//! What is said of a part is said by a point of a design, and holds for all that
//! the part becomes: where it is split, for each of the pieces.

use crate::geometry::{DVec2, RANGE_MESSAGE, Side, Similarity, is_in_range};
use crate::time::easing::EasingFunction;
use crate::warp::PartClock;
use serde::{Deserialize, Serialize};

/// When a part makes its way within the film.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PartTime {
    /// The design in which the part is named.
    pub side: Side,
    /// A point in or near it: in a document in the design's own coordinates, in a
    /// specification in those of the common frame.
    pub at: DVec2,
    /// When it sets out, from 0.
    #[serde(default)]
    pub from: f64,
    /// When it arrives, later than that, up to 1.
    #[serde(default = "one")]
    pub to: f64,
    /// How it runs in between.
    #[serde(default)]
    pub easing: EasingFunction,
}

/// Several times as many as parts that are matched.
const MOST_TIMES: usize = 2000;

fn one() -> f64 {
    1.0
}

/// A time that cannot be meant. Parts count from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartTimeError {
    /// More than there can be parts.
    #[error("{0} times of parts are too many; give {MOST_TIMES} at most")]
    TooMany(usize),
    /// The point is too far out.
    #[error("the part of time {} {RANGE_MESSAGE}", .0 + 1)]
    Place(usize),
    /// It does not set out and then arrive.
    #[error(
        "a part cannot make its way from t = {from} to t = {to}; give two numbers from 0 to 1, the first of them smaller"
    )]
    Span {
        /// When it was to set out.
        from: f64,
        /// When it was to arrive.
        to: f64,
    },
}

impl PartTime {
    /// Checks that all are places and times that can be meant.
    ///
    /// # Errors
    /// [`PartTimeError`] names the first that is none.
    pub fn check(all: &[Self]) -> Result<(), PartTimeError> {
        if all.len() > MOST_TIMES {
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

    /// When it makes its way.
    #[must_use]
    pub fn clock(&self) -> PartClock {
        let Self {
            from, to, easing, ..
        } = *self;
        PartClock { from, to, easing }
    }

    /// The same by another clock.
    #[must_use]
    pub fn with_clock(self, PartClock { from, to, easing }: PartClock) -> Self {
        Self {
            from,
            to,
            easing,
            ..self
        }
    }

    /// The same said of designs that were laid down by one similarity each.
    #[must_use]
    pub fn placed(&self, by: &[Similarity; 2]) -> Self {
        Self {
            at: by[self.side].apply(self.at),
            ..*self
        }
    }

    /// The same of the designs exchanged, whose film runs the other way.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..self.with_clock(self.clock().backwards())
        }
    }
}
