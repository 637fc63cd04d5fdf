//! Building blocks of all panels: colours, icons, controls and textures.

pub mod easing_editor;
pub mod icons;
pub mod text;
pub mod texture;
pub mod theme;
pub mod time_bar;
pub mod widgets;
