//! The strips at the bottom: transport, track and plots.

mod ease;
mod filmstrip;
pub mod plots;
pub mod strip;
pub mod track;
pub mod transport;
