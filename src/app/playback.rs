//! Time: t, how it moves, what it moves on the stage, and how often the window draws.

pub mod player;
