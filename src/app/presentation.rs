//! Talks: the drawing alone in full screen, and the speaker's window.

pub mod presenter;
pub mod speaker_window;
