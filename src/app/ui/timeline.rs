//! Panels at the bottom: transport controls, track with film strip, and graphs over time.

mod design_thumbnails;
mod filmstrip;
pub mod panel;
pub mod plots;
mod ruler;
pub mod track;
pub mod transport;
