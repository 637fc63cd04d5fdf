//! Transient parts and holes, which exist in only one design: where and when they appear or
//! disappear, and their shapes during the motion.

pub(crate) mod boundary_loops;
pub(crate) mod growth_profile;
pub(crate) mod holes;
pub(crate) mod layered_outline;
pub(crate) mod layers;
pub(crate) mod placement;
pub(crate) mod sample_times;
pub(crate) mod schedule;
pub(crate) mod shapes;
