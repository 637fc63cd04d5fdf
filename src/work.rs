//! Long computations: progress reports, cancellation, and limits on the size of a job.

pub mod budget;
pub mod progress;
