//! Two designs as rigid parts: one triangulation of both, interpolated.
//!
//! Two meshes bring their triangulation along, two trusses their panels; all
//! other forms are matched as outlines.

use super::coating::{self, Walks};
use super::drawings::Drawings;
use super::error::BuildError;
use super::found;
use super::kept::{self, Kept};
use super::lone;
use super::moved::{AnyWarp, Moved};
use super::rigid::allow;
use super::settled;
use super::spec::TransitionSpec;
use crate::compatible::{CompatibleError, CompatibleMesh, TrussError};
use crate::content::Solid;
use crate::design::Form;
use crate::progress::{Progress, checkpoint};
use crate::warp::Arap;
use std::sync::Arc;

/// The parts, and what is seen of them.
pub(super) fn rigid_parts(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(Moved, Solid), BuildError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let mut bars = Vec::new();
    let mut drawings = None;
    let (arap, kept) = match (&spec.source.form, &spec.target.form) {
        (Form::Mesh(a), Form::Mesh(b)) => {
            let mesh = CompatibleMesh::from_meshes(a, b);
            (given(spec, mesh, progress)?, None)
        }
        (Form::Truss(a), Form::Truss(b)) => {
            bars = a.bars().to_vec();
            let mesh = CompatibleMesh::from_trusses(a, b, progress);
            (given(spec, mesh, progress)?, None)
        }
        _ => {
            let drawn = drawings.insert(spec.drawings(bar_width, progress)?);
            let kept = found_or_best(spec, drawn, progress)?;
            let arap = settled::as_options_ask(&kept.film.arap, &spec.options.arap, progress)?;
            (arap, Some(Arc::new(kept)))
        }
    };
    let film = kept.as_ref().map(|kept| &kept.film);
    let holes = film.iter().flat_map(|film| &film.holes);
    let (swells, specks) =
        film.map_or_else(Default::default, |film| lone::drawn(&arap, &film.swelling));
    let coating = film.zip(drawings).and_then(|(film, drawings)| {
        let walks = Walks::of_mesh(arap.mesh());
        coating::coating(&drawings, &film.matched, &walks, &film.holes)
    });
    let solid = Solid {
        loops: if bars.is_empty() {
            arap.mesh().boundary_loops()
        } else {
            Vec::new()
        },
        bars,
        bar_width,
        holes: holes.map(|(_, hole)| hole.clone()).collect(),
        swells,
        specks,
        coating,
        clocks: None,
    };
    let moved = Moved {
        matched: film.map(|film| film.matched.clone()),
        notes: film.map_or_else(Vec::new, |film| film.notes.clone()),
        kept,
        ..AnyWarp::Rigid(arap).into()
    };
    Ok((moved, solid))
}

/// What was found before for the same outlines and options, or the best film.
fn found_or_best(
    spec: &TransitionSpec,
    drawings: &Drawings,
    progress: &dyn Progress,
) -> Result<Kept, BuildError> {
    let key = found::key(&spec.options, drawings);
    let film = match kept::film(&spec.found, &key, &spec.options, progress)? {
        Some(film) => film,
        None => settled::best(spec, drawings, progress)?,
    };
    Ok(Kept { key, film })
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
