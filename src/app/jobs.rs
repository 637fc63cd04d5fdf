//! What the program tells: work that goes on beside the window, and notices.

pub mod allocator;
pub mod job;
