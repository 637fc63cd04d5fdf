//! The strips at the bottom: transport, track and plots.

mod design_thumbnails;
mod filmstrip;
pub mod panel;
pub mod plots;
mod ruler;
pub mod track;
pub mod transport;
