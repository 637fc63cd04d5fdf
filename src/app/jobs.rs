//! Background jobs, and the allocator settings of a process that runs many threads.

pub mod allocator;
pub mod job;
