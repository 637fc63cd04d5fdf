//! Time: easing functions, and the timing of playback (duration, pauses, stops).

mod easing;
mod easing_curve;
mod timing;

pub use easing::NamedEasing;
pub use easing_curve::{EasingBezier, EasingBezierError, EasingFunction};
pub use timing::{PlayMode, Timing, TimingError, TransitionStop};
