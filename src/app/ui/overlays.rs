//! Overlays of the user interface, which appear on demand: file dialog, list of shortcuts,
//! questions, notices, progress of jobs, and frame times.

pub mod file_dialog;
mod file_side_panel;
pub mod frame_times;
pub mod help;
pub mod notices;
pub mod progress;
pub mod questions;
