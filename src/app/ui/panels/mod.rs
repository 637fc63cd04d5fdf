//! The panel on the right: everything that can be set about the transition.

pub mod appearance;
pub mod contents;
pub mod designs;
pub mod film;
pub mod inspector;
pub mod map;
pub mod matching;
pub mod method;
pub mod parts;
pub mod rigid;
pub mod warps;
