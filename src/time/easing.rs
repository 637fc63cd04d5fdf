//! Named easing functions. An easing function is an increasing function from [0, 1] onto [0, 1]; it
//! shapes how t runs over time, or how one colour fades into another.
//!
//! This file contains the four named easings. The module `easing_curve` adds cubic Bézier easings
//! with two free handles.

use crate::settings::named;

/// Named easing function on [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NamedEasing {
    /// Constant speed: f(x) = x.
    Linear,
    /// Slow at both ends (smoothstep): f(x) = 3x² − 2x³.
    #[default]
    Smooth,
    /// Slow at the start: f(x) = x².
    EaseIn,
    /// Slow at the end: f(x) = 1 − (1 − x)².
    EaseOut,
}

named! { NamedEasing {
    Linear: "linear", "Linear", "Constant speed";
    Smooth: "smooth", "Smooth", "Slow at both ends";
    EaseIn: "ease-in", "Ease in", "Slow at the start";
    EaseOut: "ease-out", "Ease out", "Slow at the end";
} }

impl NamedEasing {
    /// Returns the value of the easing at `x` in [0, 1]. The easing maps [0, 1] onto itself and is
    /// strictly increasing.
    #[must_use]
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Smooth => x * x * (3.0 - 2.0 * x),
            Self::EaseIn => x * x,
            Self::EaseOut => x * (2.0 - x),
        }
    }

    /// Returns the easing that gives the same motion when time runs backwards: x ↦ 1 − f(1 − x).
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Linear | Self::Smooth => self,
            Self::EaseIn => Self::EaseOut,
            Self::EaseOut => Self::EaseIn,
        }
    }

    /// Returns the `x` at which the easing has the value `y`: the inverse of [`Self::apply`].
    /// Values outside [0, 1] are clamped.
    #[must_use]
    pub fn inverse(self, y: f64) -> f64 {
        // Outside [0, 1] the square roots and the arcsine would be NaN.
        let y = y.clamp(0.0, 1.0);
        match self {
            Self::Linear => y,
            // Closed-form inverse of smoothstep: the trigonometric root of the cubic.
            Self::Smooth => 0.5 - ((1.0 - 2.0 * y).asin() / 3.0).sin(),
            Self::EaseIn => y.sqrt(),
            Self::EaseOut => 1.0 - (1.0 - y).sqrt(),
        }
    }
}
