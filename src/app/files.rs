//! Files: opening, changing, saving and closing projects; the file dialog, dropped files, the
//! invitation at the start, and the gallery's thumbnails.

pub mod drop;
pub mod file_dialog;
pub mod file_preview;
pub mod file_watcher;
pub mod gallery_thumbnails;
pub mod invitation;
pub mod path_completion;
pub mod picture_readings;
pub mod project_actions;
pub mod text_fonts;
