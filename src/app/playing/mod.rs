//! Time: t, how it moves, what it moves on the stage, and how often the window draws.

pub mod pace;
pub mod playback;
pub mod presenting;
pub mod speaker;
pub mod staging;
