//! Better angles in both designs at once, never leaving validity: flips,
//! collapses of needless vertices, splits, and moves that lower the cost of
//! the faces (see [`super::face`]) in both embeddings together.

use super::face;
use super::lbfgs::minimise;
use super::pair::PairMesh;
use super::transfer::split_chords;
use super::{PolygonOptions, PolygonsError, checked};
use crate::geometry::{DVec2, twice_signed_area};
use crate::progress::Progress;

/// Rounds of flips and moves.
const ROUNDS: usize = 6;
/// Steps of the common minimisation in each round.
const STEPS: usize = 60;
/// Faces that cost more are split while there is room.
const COSTLY: f64 = 2.5;
/// A vertex goes if no face around it then costs more than this.
const GOOD: f64 = 2.0;
/// Rounds in which the base loses its needless vertices.
const THINNING_ROUNDS: usize = 12;

/// Flips, moves and splits until little changes.
pub(super) fn improve(
    mesh: &mut PairMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<(), PolygonsError> {
    for round in 0..ROUNDS {
        checked(progress, "improving", round as f64 / ROUNDS as f64)?;
        flip_all(mesh);
        split_chords(mesh);
        if round + 1 < ROUNDS {
            split_long(mesh, options);
            split_costly(mesh, options);
        }
        flip_all(mesh);
        relax(mesh);
    }
    Ok(())
}

/// Splits the worst faces at their longest inner edge, in the design where
/// that is longer for the size of the face: more freedom where it is needed.
fn split_costly(mesh: &mut PairMesh, options: &PolygonOptions) {
    let n = mesh.fixed;
    let room = super::most_points(n, options).saturating_sub(mesh.steiner().count());
    let mut costly: Vec<([u32; 3], f64)> = mesh
        .faces()
        .map(|face| (face, mesh.cost(face)))
        .filter(|(_, cost)| *cost > COSTLY)
        .collect();
    costly.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut touched = std::collections::HashSet::new();
    let mut splits = 0;
    for (face, _) in costly {
        if splits >= room.min(1 + n / 3) {
            break;
        }
        if face.iter().any(|v| touched.contains(v)) {
            continue;
        }
        let edges = [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]];
        let corners = mesh.corners(face);
        let thin = if face::shape(corners[0]) > face::shape(corners[1]) {
            0
        } else {
            1
        };
        let length = |[a, b]: [u32; 2]| {
            mesh.points[thin][a as usize].distance(mesh.points[thin][b as usize])
        };
        let longest = edges
            .into_iter()
            .filter(|&edge| mesh.is_inner(edge))
            .max_by(|&a, &b| length(a).total_cmp(&length(b)));
        if longest.and_then(|edge| mesh.split(edge)).is_some() {
            touched.extend(face);
            splits += 1;
        }
    }
}

/// Takes needless vertices out of a mesh that has far too many.
pub(super) fn thin_out(mesh: &mut PairMesh, progress: &dyn Progress) -> Result<(), PolygonsError> {
    for round in 0..THINNING_ROUNDS {
        checked(
            progress,
            "simplifying",
            round as f64 / THINNING_ROUNDS as f64,
        )?;
        flip_all(mesh);
        let removed = collapse_all(mesh);
        nudge_all(mesh);
        if removed == 0 && round > 1 {
            break;
        }
    }
    Ok(())
}

fn flip_all(mesh: &mut PairMesh) {
    const PASSES: usize = 6;
    for _ in 0..PASSES {
        let edges = mesh.inner_edges();
        let flipped = edges.into_iter().filter(|&edge| mesh.flip_if_better(edge));
        if flipped.count() == 0 {
            break;
        }
    }
}

fn collapse_all(mesh: &mut PairMesh) -> usize {
    let mut removed = 0;
    for v in mesh.steiner() {
        let present = mesh
            .faces_at(v)
            .map(|face| mesh.cost(face))
            .fold(GOOD, f64::max);
        let best = mesh
            .neighbours(v)
            .into_iter()
            .map(|u| (mesh.collapse_cost(v, u), u))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((cost, onto)) = best.filter(|(cost, _)| *cost <= present) {
            if cost.is_finite() {
                mesh.collapse(v, onto);
                removed += 1;
            }
        }
    }
    removed
}

/// Splits edges longer than asked for in either design.
fn split_long(mesh: &mut PairMesh, options: &PolygonOptions) {
    let Some(share) = options.edge_length else {
        return;
    };
    let n = mesh.fixed;
    let longest = [0, 1].map(|d| 1.5 * share * super::diameter(&mesh.points[d][..n]));
    let most = super::most_points(n, options);
    for [a, b] in mesh.inner_edges() {
        let long = (0..2)
            .any(|d| mesh.points[d][a as usize].distance(mesh.points[d][b as usize]) > longest[d]);
        if long && mesh.steiner().count() < most {
            mesh.split([a, b]);
        }
    }
}

/// Each movable vertex in turn moved downhill, in both designs at once.
fn nudge_all(mesh: &mut PairMesh) {
    const PASSES: usize = 3;
    for _ in 0..PASSES {
        for v in mesh.steiner() {
            nudge(mesh, v);
        }
    }
}

fn nudge(mesh: &mut PairMesh, v: u32) {
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
    for d in 0..2 {
        mesh.points[d][v as usize] = start[d];
    }
}

/// Downhill in each design, as long as the nearest neighbour is far.
fn descent(mesh: &PairMesh, v: u32, faces: &[[u32; 3]]) -> [DVec2; 2] {
    let mut gradients = [DVec2::ZERO; 2];
    let mut reach = [f64::INFINITY; 2];
    for &face in faces {
        let [p, q] = mesh.corners(face);
        let Some(cost) = face::evaluate(p, q) else {
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

/// What the minimisation over all movable vertices needs to know.
struct Relaxation {
    /// Faces with their weights.
    faces: Vec<([u32; 3], f64)>,
    /// For each vertex its place among the unknowns.
    unknown: Vec<Option<usize>>,
    start: [Vec<DVec2>; 2],
    /// Units of the unknowns of each vertex in each design.
    units: [Vec<f64>; 2],
}

impl Relaxation {
    fn of(mesh: &PairMesh) -> Self {
        let faces = weighted(mesh);
        let vertices = mesh.points[0].len();
        let mut unknown = vec![None; vertices];
        for (i, v) in mesh.steiner().enumerate() {
            unknown[v as usize] = Some(i);
        }
        let mut weight = vec![0.0; vertices];
        let mut shortest = [vec![f64::INFINITY; vertices], vec![f64::INFINITY; vertices]];
        for &(face, share) in &faces {
            for k in 0..3 {
                let [a, b] = [face[k] as usize, face[(k + 1) % 3] as usize];
                weight[a] += share;
                for (d, shortest) in shortest.iter_mut().enumerate() {
                    let length = mesh.points[d][a].distance(mesh.points[d][b]);
                    shortest[a] = shortest[a].min(length);
                    shortest[b] = shortest[b].min(length);
                }
            }
        }
        let units = shortest.map(|s| s.iter().zip(&weight).map(|(s, w)| s / w.sqrt()).collect());
        Self {
            faces,
            unknown,
            start: mesh.points.clone(),
            units,
        }
    }

    fn at(&self, design: usize, v: u32, x: &[f64]) -> DVec2 {
        let start = self.start[design][v as usize];
        match self.unknown[v as usize] {
            None => start,
            Some(i) => {
                let k = 4 * i + 2 * design;
                start + self.units[design][v as usize] * DVec2::new(x[k], x[k + 1])
            }
        }
    }

    fn energy(&self, x: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let mut total = 0.0;
        for &(face, weight) in &self.faces {
            let [p, q] = [0, 1].map(|d| face.map(|v| self.at(d, v, x)));
            let Some(cost) = face::evaluate(p, q) else {
                return f64::INFINITY;
            };
            total += weight * cost.value;
            for (k, &v) in face.iter().enumerate() {
                let Some(i) = self.unknown[v as usize] else {
                    continue;
                };
                for d in 0..2 {
                    let g = weight * self.units[d][v as usize] * cost.gradients[d][k];
                    gradient[4 * i + 2 * d] += g.x;
                    gradient[4 * i + 2 * d + 1] += g.y;
                }
            }
        }
        total
    }
}

/// Faces weighted half by their mean share of both areas, half alike.
pub(super) fn weighted(mesh: &PairMesh) -> Vec<([u32; 3], f64)> {
    let areas = |face| {
        mesh.corners(face)
            .map(|c| twice_signed_area(c[0], c[1], c[2]))
    };
    let mut total = [0.0; 2];
    let mut count = 0.0;
    for face in mesh.faces() {
        let area = areas(face);
        total = [total[0] + area[0], total[1] + area[1]];
        count += 1.0;
    }
    let weight = |face| {
        let area = areas(face);
        0.25 * (area[0] / total[0] + area[1] / total[1]) + 0.5 / count
    };
    mesh.faces().map(|face| (face, weight(face))).collect()
}

/// All movable vertices moved together; given up if rounding leaves a face
/// that is not exactly positive.
fn relax(mesh: &mut PairMesh) {
    let relaxation = Relaxation::of(mesh);
    let mut x = vec![0.0; 4 * mesh.steiner().count()];
    minimise(&mut x, STEPS, 1e-5, |x, gradient| {
        relaxation.energy(x, gradient)
    });
    let before = mesh.points.clone();
    for v in mesh.steiner() {
        for d in 0..2 {
            mesh.points[d][v as usize] = relaxation.at(d, v, &x);
        }
    }
    if !mesh.is_valid() {
        mesh.points = before;
    }
}
