//! Two designs as rigid parts: one triangulation of both, interpolated.
//!
//! Two meshes bring their triangulation along, two trusses their panels; all
//! other forms are matched as outlines.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::arap_build::check_size;
use super::cached_match;
use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::options::PaintRule;
use super::piece_coating;
use super::piece_coating::PieceBoundaryLoops;
use super::rigid_solution;
use super::solution_cache;
use super::solution_cache::KeyedSolution;
use super::spec::TransitionSpec;
use super::transients::shapes;
use crate::colour::{Paint, Rgb};
use crate::compatible::{CompatibleError, CompatibleMesh, TrussError};
use crate::content::SolidContent;
use crate::design::{DesignForm, Truss};
use crate::warp::Arap;
use crate::work::progress::{Progress, checkpoint};
use std::collections::HashMap;
use std::sync::Arc;

/// The parts, and what is seen of them.
pub(super) fn rigid_parts(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(BuiltWarp, SolidContent), BuildError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let mut solid = SolidContent {
        bar_width,
        ..SolidContent::default()
    };
    let mut drawings = None;
    let (arap, kept) = match (&spec.source.form, &spec.target.form) {
        (DesignForm::Mesh(a), DesignForm::Mesh(b)) => {
            let mesh = CompatibleMesh::from_meshes(a, b);
            (given(spec, mesh, progress)?, None)
        }
        (DesignForm::Truss(a), DesignForm::Truss(b)) => {
            solid.bars = a.bars().to_vec();
            solid.bar_paints = paints(spec.options.paint, [a, b]);
            let mesh = CompatibleMesh::from_trusses(a, b, progress);
            (given(spec, mesh, progress)?, None)
        }
        _ => {
            let drawn = drawings.insert(spec.drawings(bar_width, progress)?);
            let kept = found_or_best(spec, drawn, progress)?;
            let arap = rigid_solution::with_requested_options(
                &kept.film.arap,
                &spec.options.arap,
                progress,
            )?;
            (arap, Some(Arc::new(kept)))
        }
    };
    // The panels of a truss carry its nodes, and are not seen.
    if solid.bars.is_empty() {
        solid.loops = arap.mesh().boundary_loops();
    }
    let film = kept.as_ref().map(|kept| &kept.film);
    if let Some((film, drawings)) = film.zip(drawings) {
        let walks = PieceBoundaryLoops::of_mesh(arap.mesh());
        solid.coating = piece_coating::coating(&drawings, &film.matched, &walks, &film.holes);
        solid.holes = film.holes.iter().map(|(_, hole)| hole.clone()).collect();
        (solid.swells, solid.specks) = shapes::drawn(&arap, &film.swelling);
    }
    let moved = BuiltWarp {
        matched: film.map(|film| film.matched.clone()),
        notes: film.map_or_else(Vec::new, |film| film.notes.clone()),
        kept,
        ..AnyWarp::Rigid(arap).into()
    };
    Ok((moved, solid))
}

/// The paints of the bars of two trusses, as the first lists them.
fn paints(rule: PaintRule, trusses: [&Truss; 2]) -> Vec<[Option<Paint>; 2]> {
    let is_painted = |truss: &&Truss| !truss.parts().colours.is_empty();
    if rule == PaintRule::One || !trusses.iter().any(is_painted) {
        return Vec::new();
    }
    let undirected = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let of_bars = trusses.map(|truss| -> HashMap<[u32; 2], Rgb> {
        let bars = truss.bars().iter().map(|&bar| undirected(bar));
        bars.zip(truss.parts().colours.iter().copied()).collect()
    });
    let bars = trusses[0].bars().iter();
    let paint = |bar: [u32; 2]| of_bars.each_ref().map(|of| Some((*of.get(&bar)?).into()));
    bars.map(|&bar| paint(undirected(bar))).collect()
}

/// What was found before for the same outlines and options, or the best film.
fn found_or_best(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    progress: &dyn Progress,
) -> Result<KeyedSolution, BuildError> {
    let key = cached_match::cache_key(&spec.options, drawings);
    let film = match solution_cache::restore(&spec.found, &key, &spec.options, progress)? {
        Some(film) => film,
        None => rigid_solution::solve_best(spec, drawings, progress)?,
    };
    Ok(KeyedSolution { key, film })
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
    check_size(&mesh, options, progress)?;
    Ok(Arap::build(&mesh, options, progress)?)
}
