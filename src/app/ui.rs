//! User interface of the window: panels, overlays and dialogs around the stage. Only this folder
//! uses egui.
//!
//! The user interface reads the [`ui_state::UiState`] and sends [`Intent`](crate::app::Intent)s; it
//! does not change the application's state itself. egui receives key events only while a text
//! field, a menu or the file dialog is in use. Otherwise a key such as Space could act on a widget
//! and on the playback at once.

pub mod draw;
mod gallery;
mod kit;
mod match_editor;
mod overlays;
mod panels;
mod speaker;
mod stage;
mod timeline;
mod toolbar;
mod ui_state;
