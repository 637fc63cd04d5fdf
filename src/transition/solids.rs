//! Builds transitions of rigid parts: a common triangulation of both designs, interpolated as
//! rigidly as possible.
//!
//! Two meshes are interpolated with their own triangulation, and two trusses with the triangulated
//! areas between their bars; all other designs are matched as outlines.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::arap_build::check_size;
use super::cached_match;
use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::note::TransitionNote;
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

/// Builds the interpolation of rigid parts, and the content that is shown.
///
/// # Errors
/// If the designs cannot be matched or triangulated, are too large, or the work is cancelled.
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
    let (arap, solved) = match (&spec.source.form, &spec.target.form) {
        (DesignForm::Mesh(a), DesignForm::Mesh(b)) => {
            let mesh = CompatibleMesh::from_meshes(a, b);
            (from_common_mesh(spec, mesh, progress)?, None)
        }
        (DesignForm::Truss(a), DesignForm::Truss(b)) => {
            solid.bars = a.bars().to_vec();
            solid.bar_paints = bar_paints(spec.options.paint, [a, b]);
            let mesh = CompatibleMesh::from_trusses(a, b, progress);
            (from_common_mesh(spec, mesh, progress)?, None)
        }
        _ => {
            let pair = drawings.insert(spec.drawings(bar_width, progress)?);
            let solved = cached_or_best(spec, pair, progress)?;
            let (motion, options) = (&solved.solution.arap, &spec.options.arap);
            let arap = rigid_solution::with_requested_options(motion, options, progress)?;
            (arap, Some(Arc::new(solved)))
        }
    };
    // The mesh of a truss only determines the motion of its joints. It is invisible, so its loops
    // are not drawn.
    if solid.bars.is_empty() {
        solid.loops = arap.mesh().boundary_loops();
    }
    let solution = solved.as_ref().map(|solved| &solved.solution);
    let mut notes = solution.map_or_else(Vec::new, |solution| solution.notes.clone());
    notes.extend(drawings.as_ref().and_then(DrawingPair::note));
    if let Some((solution, drawings)) = solution.zip(drawings) {
        let loops = PieceBoundaryLoops::of_mesh(arap.mesh());
        solid.paint_layers =
            piece_coating::paint_layer_stack(&drawings, &solution.matched, &loops, &solution.holes);
        solid.holes = solution
            .holes
            .iter()
            .map(|(_, hole)| hole.clone())
            .collect();
        (solid.swelling_shapes, solid.seed_shapes) = shapes::drawn(&arap, &solution.swelling);
    }
    let built = BuiltWarp {
        matched: solution.map(|solution| solution.matched.clone()),
        notes,
        solution: solved,
        ..AnyWarp::Rigid(arap).into()
    };
    Ok((built, solid))
}

/// For each bar of the first truss, returns its paints in source and target. Empty if neither truss
/// has colours or the colours are not used.
fn bar_paints(rule: PaintRule, trusses: [&Truss; 2]) -> Vec<[Option<Paint>; 2]> {
    let is_painted = |truss: &&Truss| !truss.parts().colours.is_empty();
    if rule == PaintRule::One || !trusses.iter().any(is_painted) {
        return Vec::new();
    }
    let undirected = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let colour_maps = trusses.map(|truss| -> HashMap<[u32; 2], Rgb> {
        let bars = truss.bars().iter().map(|&bar| undirected(bar));
        bars.zip(truss.parts().colours.iter().copied()).collect()
    });
    let bars = trusses[0].bars().iter();
    let paint = |bar: [u32; 2]| {
        let colours = colour_maps.each_ref();
        colours.map(|colour_of| Some((*colour_of.get(&bar)?).into()))
    };
    bars.map(|&bar| paint(undirected(bar))).collect()
}

/// Returns the cached solution for the same outlines and options, or computes the best one.
fn cached_or_best(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    progress: &dyn Progress,
) -> Result<KeyedSolution, BuildError> {
    let key = cached_match::cache_key(&spec.options, drawings);
    let found = &spec.cached_match;
    let is_found = found.is_for(&key);
    let restored = match is_found {
        true => solution_cache::restore(found, &drawings.outlines, &spec.options, progress)?,
        false => None,
    };
    let solution = match restored {
        Some(solution) => solution,
        None => {
            let mut solution = rigid_solution::solve_best(spec, drawings, progress)?;
            if is_found {
                solution.notes.push(TransitionNote::CachedMatchIgnored);
            }
            solution
        }
    };
    Ok(KeyedSolution { key, solution })
}

/// Builds the interpolation of a triangulation that both designs already share.
fn from_common_mesh(
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
