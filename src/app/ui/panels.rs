//! Sections of the inspector, the panel on the right. Each module draws one section or a group of
//! sections.

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
