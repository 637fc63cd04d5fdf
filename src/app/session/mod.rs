//! The project that is open: its files, its history, and the work on its transition.

pub mod history;
pub mod loading;
pub mod saving;
pub mod state;
