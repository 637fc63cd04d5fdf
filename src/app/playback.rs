//! Playback: the blend parameter t and how it moves.

pub mod player;
