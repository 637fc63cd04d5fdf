//! Building blocks of all panels: theme, icons, controls, editors of easings and time windows, and
//! textures.

pub mod easing_editor;
pub mod icons;
pub mod text;
pub mod texture;
pub mod theme;
pub mod time_bar;
pub mod widgets;
