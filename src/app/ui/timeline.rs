//! Panels at the bottom of the window: the timeline (playback controls, track of t with stops, and
//! film strip), and graphs of measured quantities over t.

mod design_thumbnails;
mod filmstrip;
pub mod panel;
pub mod plots;
mod ruler;
pub mod track;
pub mod transport;
