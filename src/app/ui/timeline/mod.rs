//! The strips at the bottom: transport, track and plots.

mod designs;
mod filmstrip;
pub mod plots;
mod ruler;
pub mod strip;
pub mod track;
pub mod transport;
