//! Builds rigidity-preserving interpolations after checking the size of their mesh, and determines
//! the options with which matches are searched.

use super::error::BuildError;
use crate::compatible::CompatibleMesh;
use crate::warp::{Arap, ArapOptions, ArapPath, TimeWindow};
use crate::work::budget::WorkloadKind;
use crate::work::progress::Progress;

/// Builds the interpolation of a mesh of outlines. `time_windows` holds, for each connected part,
/// the time window in which the part changes its size if it exists in only one design.
///
/// # Errors
/// If the mesh is too large, the equations cannot be solved, or the work is cancelled.
pub(super) fn build_arap(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    time_windows: &[Option<TimeWindow>],
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    check_size(mesh, options, progress)?;
    Ok(Arap::of_outlines(mesh, options, time_windows, progress)?)
}

/// Checks that a mesh, once subdivided as requested, does not have too many faces.
///
/// # Errors
/// [`BuildError::TooMuch`] if it has too many.
pub(super) fn check_size(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    progress: &dyn Progress,
) -> Result<(), BuildError> {
    let face_factor = 4_usize.saturating_pow(options.subdivisions);
    Ok(WorkloadKind::Faces.check(mesh.faces().len().saturating_mul(face_factor), progress)?)
}

/// Returns the options with which matches are searched and solved.
///
/// Subdivision is turned off: a finer mesh moves almost identically but takes several times as
/// long. The option `path`, which determines how the design as a whole travels, is reset to its
/// default, because a requested anchor may be a vertex that only the subdivided mesh has. That
/// option does not affect how the parts of the design move relative to each other.
pub(super) fn without_subdivision(requested: &ArapOptions) -> ArapOptions {
    ArapOptions {
        subdivisions: 0,
        path: ArapPath::default(),
        ..requested.clone()
    }
}
