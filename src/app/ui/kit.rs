//! What all panels are made of: colours, icons, controls.

pub mod easing_editor;
pub mod icons;
pub mod texture;
pub mod theme;
pub mod time_bar;
pub mod widgets;
