//! How a share runs from 0 to 1: of a segment of time, or of a mix of colours.

use crate::settings::choice::named;

pub use crate::time::easing_curve::{EasingBezier, EasingBezierError, EasingFunction};

/// How a share runs from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NamedEasing {
    /// Evenly.
    Linear,
    /// Slow at both ends: 3x² − 2x³.
    #[default]
    Smooth,
    /// Slow at the beginning: x².
    EaseIn,
    /// Slow at the end: 1 − (1−x)².
    EaseOut,
}

named! { NamedEasing {
    Linear: "linear", "Even", "The same speed all along";
    Smooth: "smooth", "Smooth", "Slow at both ends";
    EaseIn: "ease-in", "Ease in", "Slow at the beginning";
    EaseOut: "ease-out", "Ease out", "Slow at the end";
} }

impl NamedEasing {
    /// Maps [0, 1] onto itself, increasing.
    #[must_use]
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Smooth => x * x * (3.0 - 2.0 * x),
            Self::EaseIn => x * x,
            Self::EaseOut => x * (2.0 - x),
        }
    }

    /// The same in what is run backwards: 1 − f(1 − x).
    #[must_use]
    pub fn backwards(self) -> Self {
        match self {
            Self::Linear | Self::Smooth => self,
            Self::EaseIn => Self::EaseOut,
            Self::EaseOut => Self::EaseIn,
        }
    }

    /// The inverse of [`Self::apply`].
    #[must_use]
    pub fn inverse(self, y: f64) -> f64 {
        // Beyond [0, 1] roots and arc sines are NaN.
        let y = y.clamp(0.0, 1.0);
        match self {
            Self::Linear => y,
            // Smoothstep is inverted by trisecting an angle.
            Self::Smooth => 0.5 - ((1.0 - 2.0 * y).asin() / 3.0).sin(),
            Self::EaseIn => y.sqrt(),
            Self::EaseOut => 1.0 - (1.0 - y).sqrt(),
        }
    }
}
