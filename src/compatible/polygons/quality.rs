//! Better angles in both designs at once, never leaving validity: flips,
//! collapses of needless vertices, splits, and moves that lower the cost of
//! the faces (see [`super::face_cost`]) in both embeddings together.

use super::face_cost;
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::relax::relax;
use super::transfer::split_chords;
use crate::geometry::{Bounds, DVec2};
use crate::mesh::sides;
use crate::work::progress::{Cancelled, Progress, checkpoint, still_wanted};
use std::collections::HashSet;

/// Rounds of flips and moves. A trade, as all steps here: further rounds cost
/// the time of the first, and flips find less in each.
const ROUNDS: usize = 5;
/// Steps of the moves before two meshes are compared: enough to tell which is
/// the better one, since only that one is improved.
const FIRST_STEPS: usize = 20;
/// Steps of the moves in the last round, and in those before it, after which
/// the mesh is changed once more.
const STEPS: usize = 60;
const EARLY_STEPS: usize = 8;
/// Most steps times faces in each round: only meshes far larger than their
/// boundary, from the hardest matches, feel it.
const MOST_WORK: usize = 1_200_000;
/// Faces that cost more are split while there is room: where they are equilateral in both
/// designs, which costs 3, a distortion of about 1.3. By 20 instead, outlines of
/// one class are distorted by 1.87 and not by 1.77.
const COSTLY: f64 = 6.0;
/// Most faces times rounds before it is left as it is: two polygons of 200
/// corners that cross 39,000 times get the two rounds that come first.
const MOST_THINNED: usize = 150_000;
/// Rounds in which the base loses its needless vertices.
const THINNING_ROUNDS: usize = 12;

/// Flips, moves and splits until little changes.
pub(super) fn improve(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    let most = (MOST_WORK / (1 + mesh.faces().count())).max(1);
    for round in 0..ROUNDS {
        checkpoint(progress, "improving", round as f64 / ROUNDS as f64)?;
        flip_all(mesh, progress)?;
        // Flips may have made edges between boundary points.
        split_chords(mesh);
        // The last round only settles.
        if round + 1 < ROUNDS {
            split_long(mesh, options, progress)?;
            split_costly(mesh, options, progress)?;
        }
        flip_all(mesh, progress)?;
        let steps = if round + 1 < ROUNDS {
            EARLY_STEPS
        } else {
            STEPS
        };
        relax(mesh, steps.min(most), progress);
    }
    still_wanted(progress)
}

/// Flips, and splits of what is costly: the mesh changed to what its vertices
/// have become.
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

/// One round, without new vertices.
pub(super) fn settle(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    flip_all(mesh, progress)?;
    relax(mesh, FIRST_STEPS, progress);
    still_wanted(progress)
}

/// Splits the worst faces: more freedom where it is needed. Splitting many
/// more doubled the vertices of public pairs and changed no median.
fn split_costly(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    let n = mesh.fixed;
    let room = options.most_points(n).saturating_sub(mesh.steiner().len());
    let mut costly: Vec<([u32; 3], f64)> = mesh
        .faces()
        .map(|face| (face, mesh.cost(face)))
        .filter(|(_, cost)| *cost > COSTLY)
        .collect();
    // Worst first, and of neighbours one: the others change with it.
    costly.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut touched = HashSet::new();
    let mut splits = 0;
    for (face, _) in costly {
        still_wanted(progress)?;
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

/// In the design where the face is thinner.
fn longest_inner_edge(mesh: &PairMesh, face: [u32; 3]) -> Option<[u32; 2]> {
    let [p, q] = mesh.corners(face).map(face_cost::shape);
    let points = &mesh.points[usize::from(p <= q)];
    let length = |[a, b]: [u32; 2]| points[a as usize].distance_squared(points[b as usize]);
    sides(face)
        .into_iter()
        .filter(|&edge| mesh.is_inner(edge))
        .max_by(|&a, &b| length(a).total_cmp(&length(b)))
}

/// Takes needless vertices out of a mesh that has far too many.
pub(super) fn thin_out(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    for round in 0..THINNING_ROUNDS {
        checkpoint(
            progress,
            "simplifying",
            round as f64 / THINNING_ROUNDS as f64,
        )?;
        // Two rounds come first: the second collapses what the first has moved.
        if round > 1 && round * mesh.faces().count() > MOST_THINNED {
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

fn flip_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    const PASSES: usize = 6;
    for _ in 0..PASSES {
        let mut flipped = 0;
        for edge in mesh.inner_edges() {
            still_wanted(progress)?;
            // A flip takes away no listed edge but its own.
            flipped += usize::from(mesh.flip_if_better(edge));
        }
        if flipped == 0 {
            break;
        }
    }
    Ok(())
}

fn collapse_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<usize, Cancelled> {
    let mut removed = 0;
    for v in mesh.steiner() {
        still_wanted(progress)?;
        let present = mesh
            .faces_at(v)
            .map(|face| mesh.cost(face))
            .fold(0.0, f64::max);
        let best = mesh
            .neighbours(v)
            .into_iter()
            .map(|u| (mesh.collapse_cost(v, u), u))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((cost, onto)) = best.filter(|(cost, _)| *cost <= present)
            && cost.is_finite()
        {
            mesh.collapse(v, onto);
            removed += 1;
        }
    }
    Ok(removed)
}

/// Splits edges longer than asked for in either design.
fn split_long(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    let Some(share) = options.edge_length else {
        return Ok(());
    };
    let n = mesh.fixed;
    // Halves of an edge that is 1.5 times as long as wanted are nearer to what
    // is wanted than the edge is.
    let longest = [0, 1].map(|d| 1.5 * share * Bounds::diameter_of(&mesh.points[d][..n]));
    let most = options.most_points(n);
    let mut count = mesh.steiner().len();
    for [a, b] in mesh.inner_edges() {
        still_wanted(progress)?;
        let long = (0..2)
            .any(|d| mesh.points[d][a as usize].distance(mesh.points[d][b as usize]) > longest[d]);
        if long && count < most && mesh.split([a, b]).is_some() {
            count += 1;
        }
    }
    Ok(())
}

/// Each movable vertex in turn moved downhill, in both designs at once.
fn nudge_all(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), Cancelled> {
    const PASSES: usize = 3;
    for _ in 0..PASSES {
        for v in mesh.steiner() {
            still_wanted(progress)?;
            nudge(mesh, v);
        }
    }
    Ok(())
}

fn nudge(mesh: &mut PairMesh, v: u32) {
    // The last step is 0.5 · 0.25⁵ of the way to the nearest neighbour, 1/2000.
    const TRIALS: usize = 6;
    let faces: Vec<[u32; 3]> = mesh.faces_at(v).collect();
    let total = |mesh: &PairMesh| faces.iter().map(|&face| mesh.cost(face)).sum::<f64>();
    let before = total(mesh);
    if !before.is_finite() {
        return;
    }
    let start = [0, 1].map(|d| mesh.points[d][v as usize]);
    let directions = descent(mesh, v, &faces);
    let mut length = 0.5;
    for _ in 0..TRIALS {
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

/// Downhill in each design, as long as the nearest neighbour is far.
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
