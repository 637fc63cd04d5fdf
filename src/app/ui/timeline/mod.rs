//! The strips at the bottom: transport, track and plots.

mod filmstrip;
pub mod plots;
pub mod strip;
pub mod track;
pub mod transport;
