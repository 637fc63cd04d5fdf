//! What lies above everything: files, help, questions, notices, work, times.

mod beside;
pub mod files;
pub mod help;
pub mod notices;
pub mod questions;
pub mod times;
pub mod work;
