//! Two designs as rigid parts: one triangulation of both, interpolated.
//!
//! Two meshes bring their triangulation along, two trusses their panels; all
//! other forms are matched as outlines.

use super::error::BuildError;
use super::moved::{AnyWarp, Moved};
use super::rigid::allow;
use super::settled;
use super::spec::TransitionSpec;
use crate::compatible::{CompatibleError, CompatibleMesh, TrussError};
use crate::content::Solid;
use crate::design::Form;
use crate::progress::{Progress, checkpoint};
use crate::warp::Arap;

/// The parts, and what is seen of them.
pub(super) fn rigid_parts(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(Moved, Solid), BuildError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let mut bars = Vec::new();
    let (mut holes, mut notes) = (Vec::new(), Vec::new());
    let (arap, matched) = match (&spec.source.form, &spec.target.form) {
        (Form::Mesh(a), Form::Mesh(b)) => (
            given(spec, CompatibleMesh::from_meshes(a, b), progress)?,
            None,
        ),
        (Form::Truss(a), Form::Truss(b)) => {
            bars = a.bars().to_vec();
            (
                given(spec, CompatibleMesh::from_trusses(a, b, progress), progress)?,
                None,
            )
        }
        _ => {
            let outlines = spec.outlines(bar_width, progress)?;
            let best = settled::best(spec, &outlines, progress)?;
            holes = best.holes.into_iter().map(|(_, hole)| hole).collect();
            notes = best.notes;
            (best.arap, Some(best.matched))
        }
    };
    let solid = Solid {
        loops: if bars.is_empty() {
            arap.mesh().boundary_loops()
        } else {
            Vec::new()
        },
        bars,
        bar_width,
        holes,
    };
    let moved = Moved {
        matched,
        notes,
        ..AnyWarp::Rigid(arap).into()
    };
    Ok((moved, solid))
}

/// The interpolation of a triangulation that the designs brought along.
fn given(
    spec: &TransitionSpec,
    mesh: Result<CompatibleMesh, CompatibleError>,
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    let mesh = mesh.map_err(|error| match error {
        CompatibleError::Truss(TrussError::Cancelled(cancelled)) => cancelled.into(),
        CompatibleError::Truss(TrussError::TooMuch(too_much)) => too_much.into(),
        error => BuildError::from(error),
    })?;
    let options = &spec.options.arap;
    allow(&mesh, options, progress)?;
    Ok(Arap::build(&mesh, options, progress)?)
}
