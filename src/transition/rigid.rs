//! Rigid parts of a mesh that is not too large.

use super::error::BuildError;
use crate::budget::Load;
use crate::compatible::CompatibleMesh;
use crate::progress::Progress;
use crate::warp::{Arap, ArapOptions, Life};

/// The interpolation of a mesh that is not too large once it is subdivided;
/// `lives` as [`Arap::with_lives`] takes them.
pub(super) fn arap(
    mesh: &CompatibleMesh,
    options: &ArapOptions,
    lives: &[Option<Life>],
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    let children = 4_usize.saturating_pow(options.subdivisions);
    Load::Faces.allow(mesh.faces().len().saturating_mul(children), progress)?;
    Ok(Arap::with_lives(mesh, options, lives, progress)?)
}
