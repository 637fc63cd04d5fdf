//! Presentations: the drawing alone on the whole screen, and the speaker's window.

pub mod presenter;
pub mod speaker_window;
