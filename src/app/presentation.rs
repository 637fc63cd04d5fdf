//! Talks: the drawing without panels in full screen, and the speaker's window.

pub mod presenter;
pub mod speaker_window;
