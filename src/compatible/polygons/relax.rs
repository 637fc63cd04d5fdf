//! All movable vertices moved together, in both designs at once, to lower the
//! weighted sum of the faces' costs.
//!
//! Guaranteed: a valid mesh stays valid, since the cost is infinite outside
//! and the result is checked exactly. A minimum is not promised.

use super::face;
use super::lbfgs::minimise;
use super::pair::PairMesh;
use crate::geometry::{DVec2, twice_signed_area};

/// Most steps of the minimisation.
const STEPS: usize = 60;

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
pub(super) fn relax(mesh: &mut PairMesh) {
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
