//! User interface around the stage. Only this file and the files below it use egui.
//!
//! Panels read the [`ui_state::UiState`] and send [`Intent`](crate::app::Intent)s; they compute
//! nothing and change nothing themselves. Unless text is being edited egui gets no key events, so
//! Space and the arrow keys cannot drive a widget and the playback at once.

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
