//! User interface of the window: panels, overlays and dialogs around the stage. Only this folder
//! uses egui.
//!
//! The user interface reads the [`ui_state::UiState`] and sends [`Intent`](crate::app::Intent)s; it
//! does not change the application's state itself. Unless the user edits text, egui receives no key
//! events, so that a key such as Space cannot act on a widget and on the playback at once.

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
