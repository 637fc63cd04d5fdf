//! One triangulation of a piece in many designs at once.
//!
//! A refined triangulation of the piece in one of them is carried to all others, one
//! after the other: [`super::transfer`]. Whose it is, is tried in turn.
//!
//! Guaranteed: every face is positive in every design, exactly, and the first vertices
//! are the rings' points, bit by bit. Not guaranteed: that one is found.

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
use crate::work::progress::{Cancelled, Progress, checkpoint, still_wanted};
use rayon::prelude::*;

/// Faces, and for each design where their vertices are.
type SharedTriangulation = (Vec<[u32; 3]>, Vec<Vec<DVec2>>);

/// Triangulations that fold nowhere are compared until they have been carried so often in
/// all: three of four designs, and of twelve, where each takes two seconds, the first.
const CARRIED: usize = 12;

/// Rounds of lowering the distortion of each mesh that was carried.
const SETTLED: usize = 3;

/// The rings of one piece, each with its points in every design, triangulated; `first`
/// is the design that is tried first.
///
/// # Errors
/// The design whose rings bound no piece, and why; or that none was found.
pub(in crate::compatible) fn triangulate_many(
    rings: &[Vec<Vec<DVec2>>],
    first: usize,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<SharedTriangulation, (usize, Option<PieceMeshError>)> {
    let count = rings.first().map_or(0, Vec::len);
    let given: Vec<BoundaryRings> = (0..count)
        .map(|design| {
            BoundaryRings::of(&rings.iter().map(|ring| &ring[design]).collect::<Vec<_>>())
        })
        .collect();
    // Near 1 no product under- or overflows, which exact signs need.
    let scales: Vec<f64> = given
        .iter()
        .map(|rings| unit_scale(&rings.points))
        .collect();
    let scaled = given.iter().zip(&scales);
    let scaled: Vec<BoundaryRings> = scaled.map(|(rings, &by)| rings.scaled(by)).collect();
    for (design, (rings, scale)) in scaled.iter().zip(&scales).enumerate() {
        boundary_rings::check(rings, Side::Source)
            .map_err(|error| (design, Some(error.enlarged([scale.recip(); 2]))))?;
    }
    let first = found(&scaled, first, options, progress).map_err(cancelled)?;
    let (faces, mut places) = first.ok_or((0, None))?;
    for ((places, given), scale) in places.iter_mut().zip(&given).zip(&scales) {
        places.iter_mut().for_each(|p| *p /= *scale);
        places[..given.points.len()].copy_from_slice(&given.points);
    }
    Ok((faces, places))
}

/// A triangulation that folds in none of the designs, the best of the first few of them.
fn found(
    designs: &[BoundaryRings],
    first: usize,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<SharedTriangulation>, Cancelled> {
    let count = designs.len();
    let order = std::iter::once(first).chain((0..count).filter(|&k| k != first));
    let mut found = Vec::new();
    for (tried, from) in order.clone().enumerate() {
        checkpoint(progress, "triangulating", tried as f64 / count as f64)?;
        let Some(start) = alone(&designs[from], options, progress)? else {
            continue;
        };
        found.extend(carried(&start, (from, None), designs, progress)?);
        if found.len() * count >= CARRIED {
            break;
        }
    }
    // Where one design is hard, its mesh with the first, which is always found, may be
    // carried to the others, which are not.
    for hard in order.skip(1) {
        if !found.is_empty() {
            break;
        }
        let pair = triangulate_pair(&designs[first], &designs[hard], options, progress);
        still_wanted(progress)?;
        let Ok(pair) = pair else {
            continue;
        };
        let (faces, [own, theirs]) = pair.compacted();
        let start = PairMesh::new(pair.fixed, [own.clone(), own], faces);
        let known = Some((hard, theirs));
        found.extend(carried(&start, (first, known), designs, progress)?);
    }
    let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    Ok(best.map(|(_, mesh)| mesh))
}

fn cancelled(cancelled: Cancelled) -> (usize, Option<PieceMeshError>) {
    (0, Some(cancelled.into()))
}

/// The refined triangulation of one design; none where it has none.
fn alone(
    rings: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, Cancelled> {
    let n = rings.points.len();
    let refinement = RefinementOptions {
        max_edge: options
            .edge_length
            .map(|share| share * Bounds::diameter_of(&rings.points)),
        max_points: options.most_points(n),
    };
    let start = refined_delaunay(&rings.walks(), &refinement, progress);
    still_wanted(progress)?;
    let Ok(start) = start else {
        return Ok(None);
    };
    let points = start.points;
    let mut mesh = PairMesh::new(n, [points.clone(), points], start.faces);
    split_chords(&mut mesh);
    Ok(Some(mesh))
}

/// Lowers the distortion of a mesh that was carried, and folds nowhere: the harmonic map
/// of what needed no more is a poor one.
fn settle(mesh: &mut PairMesh, progress: &dyn Progress) {
    for _ in 0..SETTLED {
        let before = mesh.points[1].clone();
        let moved = mesh.is_valid() && untangle(mesh, progress);
        if !moved {
            break;
        }
        if !mesh.is_valid() {
            mesh.points[1] = before;
            break;
        }
    }
}

/// A triangulation of one design carried to all others but that in which it is known,
/// with what it costs; none where it folds in one of them.
fn carried(
    base: &PairMesh,
    (from, known): (usize, Option<(usize, Vec<DVec2>)>),
    designs: &[BoundaryRings],
    progress: &dyn Progress,
) -> Result<Option<(f64, SharedTriangulation)>, Cancelled> {
    let to = |design: usize| {
        let own = &base.points[0];
        let known = known.as_ref().filter(|(hard, _)| *hard == design);
        let mut mesh = base.clone();
        match known {
            _ if design == from => return Ok(Some((0.0, own.clone()))),
            Some((_, places)) => mesh.points[1].clone_from(places),
            None => {
                transfer_onto(&mut mesh, &designs[design].points, progress)?;
                settle(&mut mesh, progress);
            }
        }
        let is_valid = mesh.is_valid();
        Ok(is_valid.then(|| (mean_cost(&mesh), mesh.points[1].clone())))
    };
    let all: Vec<_> = (0..designs.len()).into_par_iter().map(to).collect();
    let all = all
        .into_iter()
        .collect::<Result<Option<Vec<_>>, Cancelled>>();
    let Some(all) = all? else {
        return Ok(None);
    };
    let worth = all.iter().map(|(worth, _)| worth).sum();
    let places = all.into_iter().map(|(_, places)| places).collect();
    Ok(Some((worth, (base.faces().collect(), places))))
}
