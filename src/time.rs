//! Time: easing functions, and the timing of a film (duration, pauses, stops).

pub mod easing;
pub(crate) mod easing_curve;
pub(crate) mod timing;
