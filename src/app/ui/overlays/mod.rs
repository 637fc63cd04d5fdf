//! What lies above everything: help, questions, notices, work, times.

pub mod help;
pub mod notices;
pub mod questions;
pub mod times;
pub mod work;
