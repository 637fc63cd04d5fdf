//! Rigid parts of a mesh that is not too large, and what they are settled with.

use super::error::BuildError;
use crate::compatible::CompatibleMesh;
use crate::warp::{Arap, ArapOptions, ArapPath, TimeWindow};
use crate::work::budget::WorkloadKind;
use crate::work::progress::Progress;

/// The interpolation of a mesh of outlines that is not too large; `lives` as
/// [`Arap::of_outlines`] takes them.
pub(super) fn build_arap(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    lives: &[Option<TimeWindow>],
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    check_size(mesh, options, progress)?;
    Ok(Arap::of_outlines(mesh, options, lives, progress)?)
}

/// Whether a mesh is not too large once it is subdivided.
pub(super) fn check_size(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    progress: &dyn Progress,
) -> Result<(), BuildError> {
    let children = 4_usize.saturating_pow(options.subdivisions);
    Ok(WorkloadKind::Faces.allow(mesh.faces().len().saturating_mul(children), progress)?)
}

/// What a film is settled with: of a mesh that is not subdivided. The finer one
/// moves almost alike, and looking at it would take as many times as long. Its
/// anchor may be a vertex that is not there yet; where the whole is moves nothing
/// within it.
pub(super) fn unsubdivided(asked: &ArapOptions) -> ArapOptions {
    ArapOptions {
        subdivisions: 0,
        path: ArapPath::default(),
        ..asked.clone()
    }
}
