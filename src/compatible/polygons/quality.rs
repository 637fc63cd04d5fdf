//! Improves the angles of a mesh in both designs at once and keeps it valid. It uses flips,
//! collapses of unneeded vertices, splits, and moves that lower the face costs
//! ([`super::face_cost`]).

use super::face_cost;
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::relax::relax;
use super::transfer::split_chords;
use crate::geometry::{Bounds, DVec2};
use crate::mesh::sides;
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};
use std::collections::HashSet;

/// Number of rounds of flips, splits and moves in [`improve`] (heuristic).
const ROUNDS: usize = 5;
/// Maximum number of descent steps for each of two candidate meshes before the two are compared;
/// only the better one is improved further (heuristic).
const FIRST_STEPS: usize = 20;
/// Maximum number of descent steps in the last round of [`improve`] (heuristic).
const LAST_STEPS: usize = 60;
/// Maximum number of descent steps in each earlier round of [`improve`] (heuristic: few, because
/// the next round changes the mesh again).
const EARLY_STEPS: usize = 8;
/// Maximum product of descent steps and faces in a round of [`improve`] (resource limit: it reduces
/// the steps only of meshes with more than 20,000 faces).
const MAX_WORK: usize = 1_200_000;
/// Face cost above which a face is split, until the mesh has reached its maximum number of inner
/// vertices (heuristic: an undistorted equilateral face costs about 3).
const COSTLY: f64 = 6.0;
/// Unneeded vertices are removed in rounds, as long as the product of the number of faces and the
/// round number does not exceed this. The remaining vertices stay (resource limit).
const MAX_THINNING_WORK: usize = 150_000;
/// Maximum number of rounds in which unneeded vertices are removed from a base mesh
/// ([`super::bridges`]) (resource limit).
const MAX_THINNING_ROUNDS: usize = 12;

/// Improves a mesh by several rounds of flips, splits and moves.
pub(super) fn improve(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    // Large meshes get fewer descent steps.
    let max_steps = (MAX_WORK / (1 + mesh.faces().count())).max(1);
    for round in 0..ROUNDS {
        checkpoint(progress, "improving", round as f64 / ROUNDS as f64)?;
        flip_all(mesh, progress)?;
        // Flips may have joined two boundary points by a chord. Faces whose corners are all on the
        // boundary cannot move.
        split_chords(mesh);
        // The last round adds no vertices.
        if round + 1 < ROUNDS {
            split_long(mesh, options, progress)?;
            split_costly(mesh, options, progress)?;
        }
        flip_all(mesh, progress)?;
        let steps = if round + 1 < ROUNDS {
            EARLY_STEPS
        } else {
            LAST_STEPS
        };
        relax(mesh, steps.min(max_steps), progress);
    }
    check_cancelled(progress)
}

/// Flips edges and splits costly faces of a mesh whose vertices have moved.
pub(super) fn refit(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    flip_all(mesh, progress)?;
    split_chords(mesh);
    split_costly(mesh, options, progress)?;
    flip_all(mesh, progress)
}

/// Flips edges, and then moves the inner vertices; adds no vertices.
pub(super) fn relax_and_flip(
    mesh: &mut PairMesh,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    flip_all(mesh, progress)?;
    relax(mesh, FIRST_STEPS, progress);
    check_cancelled(progress)
}

/// Splits the costliest faces, to add movable vertices where they are needed.
fn split_costly(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    let n = mesh.fixed;
    let room = options
        .max_inner_points(n)
        .saturating_sub(mesh.steiner_vertices().len());
    let mut costly: Vec<([u32; 3], f64)> = mesh
        .faces()
        .map(|face| (face, mesh.cost(face)))
        .filter(|(_, cost)| *cost > COSTLY)
        .collect();
    // The costliest faces are split first. If one of several faces that share a vertex has been
    // split, the others are left as they are, because the split may have changed their costs.
    costly.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut touched = HashSet::new();
    let mut splits = 0;
    for (face, _) in costly {
        check_cancelled(progress)?;
        // Only a few faces are split in each round, because costs change after every split.
        if splits >= room.min(1 + n / 8) {
            break;
        }
        if face.iter().any(|v| touched.contains(v)) {
            continue;
        }
        let longest = longest_inner_edge(mesh, face);
        if longest.and_then(|edge| mesh.split(edge)).is_some() {
            touched.extend(face);
            splits += 1;
        }
    }
    Ok(())
}

/// Returns the longest inner edge of a face, measured in the design where the face is thinner;
/// `None` if all its edges are on the boundary.
fn longest_inner_edge(mesh: &PairMesh, face: [u32; 3]) -> Option<[u32; 2]> {
    let [p, q] = mesh.corners(face).map(face_cost::shape);
    // The larger shape term belongs to the thinner face.
    let points = &mesh.points[usize::from(p <= q)];
    let length = |[a, b]: [u32; 2]| points[a as usize].distance_squared(points[b as usize]);
    sides(face)
        .into_iter()
        .filter(|&edge| mesh.is_inner(edge))
        .max_by(|&a, &b| length(a).total_cmp(&length(b)))
}

/// Removes unneeded vertices from a base mesh ([`super::bridges`]), which has far too many.
pub(super) fn remove_unneeded_vertices(
    mesh: &mut PairMesh,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    for round in 0..MAX_THINNING_ROUNDS {
        checkpoint(
            progress,
            "simplifying",
            round as f64 / MAX_THINNING_ROUNDS as f64,
        )?;
        // The first two rounds always run. The second one can remove vertices that the first one
        // has only moved.
        if round > 1 && round * mesh.faces().count() > MAX_THINNING_WORK {
            break;
        }
        flip_all(mesh, progress)?;
        let removed = collapse_all(mesh, progress)?;
        nudge_all(mesh, progress)?;
        if removed == 0 && round > 1 {
            break;
        }
    }
    Ok(())
}

/// Flips every edge whose flip improves its two faces, in several passes, until no flip improves
/// any.
fn flip_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    /// Maximum number of passes over all edges (resource limit).
    const MAX_PASSES: usize = 6;
    for _ in 0..MAX_PASSES {
        let mut flipped = 0;
        for edge in mesh.inner_edges() {
            check_cancelled(progress)?;
            // A flip removes only the flipped edge, so all later edges of the list still exist.
            flipped += usize::from(mesh.flip_if_better(edge));
        }
        if flipped == 0 {
            break;
        }
    }
    Ok(())
}

/// Merges inner vertices into a neighbour where that does not raise the highest cost of the faces
/// around them. Returns the number of vertices removed.
fn collapse_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<usize, Cancelled> {
    let mut removed = 0;
    for v in mesh.steiner_vertices() {
        check_cancelled(progress)?;
        let current_cost = mesh
            .faces_at(v)
            .map(|face| mesh.cost(face))
            .fold(0.0, f64::max);
        let best = mesh
            .neighbours(v)
            .into_iter()
            .map(|u| (mesh.collapse_cost(v, u), u))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        // The collapse must not make the worst face around the vertex worse.
        if let Some((cost, onto)) = best.filter(|(cost, _)| *cost <= current_cost)
            && cost.is_finite()
        {
            mesh.collapse(v, onto);
            removed += 1;
        }
    }
    Ok(removed)
}

/// Splits edges that are much longer than the requested length in either design.
fn split_long(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    let Some(share) = options.edge_length else {
        return Ok(());
    };
    let n = mesh.fixed;
    // If an edge is longer than 1.5 times the requested length, the length of each half is closer
    // to the requested length than that of the whole edge.
    let longest = [0, 1].map(|d| 1.5 * share * Bounds::diameter_of(&mesh.points[d][..n]));
    let max_count = options.max_inner_points(n);
    let mut count = mesh.steiner_vertices().len();
    for [a, b] in mesh.inner_edges() {
        check_cancelled(progress)?;
        let is_long = (0..2)
            .any(|d| mesh.points[d][a as usize].distance(mesh.points[d][b as usize]) > longest[d]);
        if is_long && count < max_count && mesh.split([a, b]).is_some() {
            count += 1;
        }
    }
    Ok(())
}

/// Moves each inner vertex in turn, in both designs at once, to lower the costs of its faces.
fn nudge_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    /// Number of passes over all vertices (heuristic).
    const PASSES: usize = 3;
    for _ in 0..PASSES {
        for v in mesh.steiner_vertices() {
            check_cancelled(progress)?;
            nudge(mesh, v);
        }
    }
    Ok(())
}

/// Moves one inner vertex along the descent direction, by backtracking. The vertex stays if no
/// trial step lowers the cost.
fn nudge(mesh: &mut PairMesh, v: u32) {
    /// Maximum number of trial steps (resource limit: the last one is 0.5 · 0.25⁵ ≈ 1/2000 of the
    /// distance to the nearest neighbour).
    const MAX_TRIALS: usize = 6;
    let faces: Vec<[u32; 3]> = mesh.faces_at(v).collect();
    let total = |mesh: &PairMesh| faces.iter().map(|&face| mesh.cost(face)).sum::<f64>();
    let before = total(mesh);
    // There is no descent direction if a face at the vertex is invalid.
    if !before.is_finite() {
        return;
    }
    let start = [0, 1].map(|d| mesh.points[d][v as usize]);
    let directions = descent(mesh, v, &faces);
    let mut length = 0.5;
    for _ in 0..MAX_TRIALS {
        for d in 0..2 {
            mesh.points[d][v as usize] = start[d] + length * directions[d];
        }
        if total(mesh) < before {
            return;
        }
        length *= 0.25;
    }
    for (points, from) in mesh.points.iter_mut().zip(start) {
        points[v as usize] = from;
    }
}

/// For each design, a vector in the direction of steepest descent of a vertex. It is as long as the
/// distance from the vertex to its nearest neighbour in that design.
fn descent(mesh: &PairMesh, v: u32, faces: &[[u32; 3]]) -> [DVec2; 2] {
    let mut gradients = [DVec2::ZERO; 2];
    let mut reach = [f64::INFINITY; 2];
    for &face in faces {
        let [p, q] = mesh.corners(face);
        let Some(cost) = face_cost::evaluate(p, q, face_cost::AREA_WEIGHT) else {
            continue;
        };
        for (k, &u) in face.iter().enumerate() {
            for d in 0..2 {
                if u == v {
                    gradients[d] += cost.gradients[d][k];
                } else {
                    let far = mesh.points[d][u as usize].distance(mesh.points[d][v as usize]);
                    reach[d] = reach[d].min(far);
                }
            }
        }
    }
    [0, 1].map(|d| -gradients[d].normalize_or_zero() * reach[d])
}
