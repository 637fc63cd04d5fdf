//! Triangulates one piece (a matched connected part) in many designs at once.
//!
//! A refined triangulation of the piece in one design is transferred to all other designs
//! ([`super::transfer`]). One design after another is tried as the start.
//!
//! Guaranteed: every face is positive in every design, by exact predicates; the first vertices are
//! the ring points, bit by bit. Not guaranteed: that a common triangulation is found.

use super::boundary_rings;
use super::boundary_rings::BoundaryRings;
use super::error::PieceMeshError;
use super::options::PolygonOptions;
use super::pair_mesh::{PairMesh, unit_scale};
use super::transfer::{split_chords, transfer_onto};
use super::two_designs::{mean_cost, triangulate_pair};
use super::untangle::untangle;
use crate::geometry::{Bounds, DVec2, Side};
use crate::mesh::triangulation::{RefinementOptions, refined_delaunay};
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};
use rayon::prelude::*;

/// Faces as triples of vertex indices, and the vertex positions in each design.
type SharedTriangulation = (Vec<[u32; 3]>, Vec<Vec<DVec2>>);

/// The search for common triangulations ends when the number found times the number of designs
/// reaches this (resource limit: that is three triangulations of four designs, or one of twelve).
const ENOUGH_TRANSFERS: usize = 12;

/// Maximum number of rounds of distortion reduction after a mesh is transferred to another design
/// (heuristic).
const REDUCTION_ROUNDS: usize = 3;

/// Triangulates one piece in all designs. `rings[ring][design]` is a list of points. `first` is the
/// index of the design with which the search starts.
///
/// # Errors
/// Index of a design whose rings are not a valid boundary, with the reason. Otherwise the index is
/// 0: without a reason if no common triangulation was found, with a reason if the work was
/// cancelled.
pub(in crate::compatible) fn triangulate_many(
    rings: &[Vec<Vec<DVec2>>],
    first: usize,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<SharedTriangulation, (usize, Option<PieceMeshError>)> {
    let count = rings.first().map_or(0, Vec::len);
    let design_rings: Vec<BoundaryRings> = (0..count)
        .map(|design| {
            BoundaryRings::of(&rings.iter().map(|ring| &ring[design]).collect::<Vec<_>>())
        })
        .collect();
    // At a diameter near 1 no product overflows or underflows, as exact predicates require.
    let scales: Vec<f64> = design_rings
        .iter()
        .map(|rings| unit_scale(&rings.points))
        .collect();
    let scaled = design_rings.iter().zip(&scales);
    let scaled: Vec<BoundaryRings> = scaled.map(|(rings, &by)| rings.scaled(by)).collect();
    for (design, (rings, scale)) in scaled.iter().zip(&scales).enumerate() {
        boundary_rings::validate_rings(rings, Side::Source)
            .map_err(|error| (design, Some(error.scaled([scale.recip(); 2]))))?;
    }
    let best = best_triangulation(&scaled, first, options, progress).map_err(cancelled)?;
    let (faces, mut places) = best.ok_or((0, None))?;
    for ((places, rings), scale) in places.iter_mut().zip(&design_rings).zip(&scales) {
        places.iter_mut().for_each(|p| *p /= *scale);
        // Restores the exact ring points.
        places[..rings.points.len()].copy_from_slice(&rings.points);
    }
    Ok((faces, places))
}

/// Returns the triangulation with the lowest cost of those found that are free of folds in all
/// designs; `None` if none is found. The search ends once it has found a few.
fn best_triangulation(
    designs: &[BoundaryRings],
    first: usize,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<SharedTriangulation>, Cancelled> {
    let count = designs.len();
    let order = std::iter::once(first).chain((0..count).filter(|&k| k != first));
    let mut candidates = Vec::new();
    for (tried, from) in order.clone().enumerate() {
        checkpoint(progress, "triangulating", tried as f64 / count as f64)?;
        let Some(start) = refined_mesh(&designs[from], options, progress)? else {
            continue;
        };
        candidates.extend(transfer_to_all(&start, from, None, designs, progress)?);
        if candidates.len() * count >= ENOUGH_TRANSFERS {
            break;
        }
    }
    // If no design's own triangulation transfers to all other designs, the common mesh of two
    // designs, `first` and `hard`, is transferred to the remaining ones. Such a mesh of two designs
    // is nearly always found.
    for hard in order.skip(1) {
        if !candidates.is_empty() {
            break;
        }
        let pair = triangulate_pair(&designs[first], &designs[hard], options, progress);
        check_cancelled(progress)?;
        let Ok(pair) = pair else {
            continue;
        };
        let (faces, [own, theirs]) = pair.compacted();
        let start = PairMesh::new(pair.fixed, [own.clone(), own], faces);
        let hard_points = Some((hard, theirs));
        candidates.extend(transfer_to_all(
            &start,
            first,
            hard_points,
            designs,
            progress,
        )?);
    }
    let best = candidates.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    Ok(best.map(|(_, mesh)| mesh))
}

/// Result of [`triangulate_many`] after a cancel.
fn cancelled(cancelled: Cancelled) -> (usize, Option<PieceMeshError>) {
    (0, Some(cancelled.into()))
}

/// Returns a refined triangulation of one design, as a mesh with that design in both embeddings;
/// `None` if the design cannot be triangulated.
fn refined_mesh(
    rings: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, Cancelled> {
    let n = rings.points.len();
    let refinement = RefinementOptions {
        max_edge: options
            .edge_length
            .map(|share| share * Bounds::diameter_of(&rings.points)),
        max_points: options.max_inner_points(n),
    };
    let start = refined_delaunay(&rings.loops(), &refinement, progress);
    check_cancelled(progress)?;
    let Ok(start) = start else {
        return Ok(None);
    };
    let points = start.points;
    let mut mesh = PairMesh::new(n, [points.clone(), points], start.faces);
    split_chords(&mut mesh);
    Ok(Some(mesh))
}

/// Reduces the distortion of a mesh that is free of folds after its transfer; leaves other meshes
/// unchanged. The inner vertices may lie where the harmonic map has placed them, and the harmonic
/// map distorts more than necessary.
fn reduce_distortion(mesh: &mut PairMesh, progress: &dyn Progress) {
    for _ in 0..REDUCTION_ROUNDS {
        let before = mesh.points[1].clone();
        let is_untangled = mesh.is_valid() && untangle(mesh, progress);
        if !is_untangled {
            break;
        }
        if !mesh.is_valid() {
            mesh.points[1] = before;
            break;
        }
    }
}

/// Transfers the triangulation `base` of the design `from` to all other designs. Returns the result
/// with the sum of its mean face costs over the other designs; `None` if the result is folded in
/// one of the designs.
///
/// If present, `hard_points` contains the index of another design and the positions of the vertices
/// in that design, which then needs no transfer.
fn transfer_to_all(
    base: &PairMesh,
    from: usize,
    hard_points: Option<(usize, Vec<DVec2>)>,
    designs: &[BoundaryRings],
    progress: &dyn Progress,
) -> Result<Option<(f64, SharedTriangulation)>, Cancelled> {
    let transferred = |design: usize| {
        let own = &base.points[0];
        let hard_points = hard_points.as_ref().filter(|(hard, _)| *hard == design);
        let mut mesh = base.clone();
        match hard_points {
            // The design `from` keeps the vertices of `base`. Its cost counts as 0.
            _ if design == from => return Ok(Some((0.0, own.clone()))),
            Some((_, places)) => mesh.points[1].clone_from(places),
            None => {
                transfer_onto(&mut mesh, &designs[design].points, progress)?;
                reduce_distortion(&mut mesh, progress);
            }
        }
        let is_valid = mesh.is_valid();
        Ok(is_valid.then(|| (mean_cost(&mesh), mesh.points[1].clone())))
    };
    // Ends with the first design in which faces remain folded.
    let all: Result<Option<Vec<_>>, Cancelled> = (0..designs.len())
        .into_par_iter()
        .map(transferred)
        .collect();
    let Some(all) = all? else {
        return Ok(None);
    };
    let cost = all.iter().map(|(cost, _)| cost).sum();
    let places = all.into_iter().map(|(_, places)| places).collect();
    Ok(Some((cost, (base.faces().collect(), places))))
}
