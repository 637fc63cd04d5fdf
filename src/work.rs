//! Long computations: progress reports, cancellation, limits on the size of a job, and panics as
//! errors.

pub mod budget;
pub(crate) mod panic_boundary;
pub mod progress;
