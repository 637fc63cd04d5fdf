//! What the program tells: work that goes on beside the window, and notices.

pub mod job;
pub mod notices;
pub mod spare;
