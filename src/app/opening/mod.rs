//! Opening, changing, saving and closing projects; the bundled ones and their film strips.

pub mod apply;
pub mod closing;
pub mod dialogs;
pub mod drops;
pub mod preview;
pub mod thumbnails;
pub mod typed;
pub mod watching;
