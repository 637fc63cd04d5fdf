//! Rigid parts of a mesh that is not too large.

use super::error::BuildError;
use crate::budget::Load;
use crate::compatible::CompatibleMesh;
use crate::progress::Progress;
use crate::warp::{Arap, ArapOptions, Life};

/// The interpolation of a mesh of outlines that is not too large; `lives` as
/// [`Arap::of_outlines`] takes them.
pub(super) fn arap(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    lives: &[Option<Life>],
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    allow(mesh, options, progress)?;
    Ok(Arap::of_outlines(mesh, options, lives, progress)?)
}

/// Whether a mesh is not too large once it is subdivided.
pub(super) fn allow(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    progress: &dyn Progress,
) -> Result<(), BuildError> {
    let children = 4_usize.saturating_pow(options.subdivisions);
    Ok(Load::Faces.allow(mesh.faces().len().saturating_mul(children), progress)?)
}
