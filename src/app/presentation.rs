//! Talks: the transition in full screen without panels, from stop to stop, and the speaker window.

pub mod presenter;
pub mod speaker_window;
