//! What is drawn around the stage. egui is named here and in the files below, nowhere else.
//!
//! Panels read a [`ui_state::UiState`] and push [`Intent`](crate::app::Intent)s; they compute nothing
//! and change nothing. While no text is being written egui gets no keys at all, so Space and the
//! arrows cannot drive a widget and the playback at once.

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
