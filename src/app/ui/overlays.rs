//! Layers above the panels: file dialog, shortcuts, questions, notices, progress and frame times.

pub mod file_dialog;
mod file_side_panel;
pub mod frame_times;
pub mod help;
pub mod notices;
pub mod progress;
pub mod questions;
