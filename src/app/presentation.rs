//! Talks: the drawing without panels in full screen, and the speaker window.

pub mod presenter;
pub mod speaker_window;
