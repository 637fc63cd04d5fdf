//! What all panels are made of: colours, icons, controls.

pub mod ease;
pub mod icons;
pub mod span;
pub mod texture;
pub mod theme;
pub mod widgets;
