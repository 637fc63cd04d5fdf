//! What all panels are made of: colours, icons, controls.

pub mod icons;
pub mod texture;
pub mod theme;
pub mod widgets;
