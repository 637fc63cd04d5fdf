//! What lies above everything: files, help, questions, notices, work, times.

pub mod file_dialog;
mod file_side_panel;
pub mod frame_times;
pub mod help;
pub mod notices;
pub mod progress;
pub mod questions;
