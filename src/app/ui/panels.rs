//! Inspector (the panel on the right), its sections, and the export settings that replace them.
//! Each module of sections draws one section or several.

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
