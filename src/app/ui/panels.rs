//! The panel on the right: everything that can be set about the transition.

pub mod appearance;
pub mod content;
pub mod designs;
pub mod export;
pub mod inspector;
pub mod map;
pub mod matching;
pub mod method;
pub mod part_timing;
pub mod rigid_motion;
pub mod warps;
