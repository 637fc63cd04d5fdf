//! All movable vertices moved together, in both designs at once, to lower the
//! weighted sum of the faces' costs.
//!
//! Guaranteed: a valid mesh stays valid, since the cost is infinite outside
//! and the result is checked exactly. A minimum is not promised.

use super::face;
use super::lbfgs::minimise;
use super::pair::PairMesh;
use super::springs::Springs;
use crate::geometry::DVec2;
use crate::progress::Progress;

/// What the minimisation over all movable vertices needs to know. Unknowns
/// are displacements: source x, source y, target x, target y.
struct Relaxation {
    /// Faces with their weights.
    faces: Vec<([u32; 3], f64)>,
    movable: Vec<u32>,
    start: [Vec<DVec2>; 2],
    /// Scratch: the vertices and the cost's gradients by them.
    at: [Vec<DVec2>; 2],
    gradients: [Vec<DVec2>; 2],
}

impl Relaxation {
    fn of(mesh: &PairMesh) -> Self {
        let zero = vec![DVec2::ZERO; mesh.points[0].len()];
        Self {
            faces: weighted(mesh),
            movable: mesh.steiner(),
            start: mesh.points.clone(),
            at: mesh.points.clone(),
            gradients: [zero.clone(), zero],
        }
    }

    /// Puts the vertices where displacements bring them.
    fn place(&mut self, x: &[f64]) {
        let n = self.movable.len();
        for d in 0..2 {
            let (along_x, along_y) = x[2 * d * n..2 * (d + 1) * n].split_at(n);
            for (i, &v) in self.movable.iter().enumerate() {
                let by = DVec2::new(along_x[i], along_y[i]);
                self.at[d][v as usize] = self.start[d][v as usize] + by;
            }
        }
    }

    fn energy(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        self.place(x);
        for gradients in &mut self.gradients {
            gradients.fill(DVec2::ZERO);
        }
        let mut total = 0.0;
        for &(face, weight) in &self.faces {
            let [p, q] = [0, 1].map(|d| face.map(|v| self.at[d][v as usize]));
            // The gradient is of no use then: the search only shortens its step.
            let Some(cost) = face::evaluate(p, q) else {
                return f64::INFINITY;
            };
            total += weight * cost.value;
            for d in 0..2 {
                for (k, &v) in face.iter().enumerate() {
                    self.gradients[d][v as usize] += weight * cost.gradients[d][k];
                }
            }
        }
        let n = self.movable.len();
        for d in 0..2 {
            for (i, &v) in self.movable.iter().enumerate() {
                let g = self.gradients[d][v as usize];
                gradient[2 * d * n + i] = g.x;
                gradient[(2 * d + 1) * n + i] = g.y;
            }
        }
        total
    }

    /// The curvature of the cost where areas are kept, as springs in each
    /// design.
    fn springs(&self, progress: &dyn Progress) -> Option<[Springs; 2]> {
        let of = |d: usize| {
            let springs = self.faces.iter().flat_map(|&(face, weight)| {
                let [p, q] = [0, 1].map(|d| face.map(|v| self.start[d][v as usize]));
                let stiffness = face::stiffness(p, q)[d];
                let ends = |k: usize| [face[(k + 1) % 3], face[(k + 2) % 3]];
                [0, 1, 2].map(|k| (ends(k), weight * stiffness[k]))
            });
            Springs::new(&self.movable, springs, progress)
        };
        // Each design for itself: what couples the two may be negative.
        Some([of(0)?, of(1)?])
    }
}

/// Faces weighted half by their mean share of both areas, half alike.
pub(super) fn weighted(mesh: &PairMesh) -> Vec<([u32; 3], f64)> {
    let areas = |face| mesh.corners(face).map(face::doubled);
    let mut total = [0.0; 2];
    let mut count = 0.0;
    for face in mesh.faces() {
        let area = areas(face);
        total = [total[0] + area[0], total[1] + area[1]];
        count += 1.0;
    }
    // By area alone the small faces of a detail would have hardly a say.
    let weight = |face| {
        let area = areas(face);
        0.25 * (area[0] / total[0] + area[1] / total[1]) + 0.5 / count
    };
    mesh.faces().map(|face| (face, weight(face))).collect()
}

/// All movable vertices moved together by at most `steps` steps; given up if
/// rounding leaves a face that is not exactly positive, and ended early by a
/// cancel.
pub(super) fn relax(mesh: &mut PairMesh, steps: usize, progress: &dyn Progress) {
    let mut relaxation = Relaxation::of(mesh);
    let Some([mut source, mut target]) = relaxation.springs(progress) else {
        return;
    };
    let n = relaxation.movable.len();
    let mut x = vec![0.0; 4 * n];
    let precondition = |forces: &mut [f64]| {
        source.solve(&mut forces[..2 * n]);
        target.solve(&mut forces[2 * n..]);
    };
    let energy = |x: &[f64], gradient: &mut [f64]| relaxation.energy(x, gradient);
    minimise(&mut x, steps, 1e-5, precondition, energy, progress);
    relaxation.place(&x);
    // The cost knows areas in plain floating point: a face that is flat but
    // for rounding may be positive to it.
    let before = std::mem::replace(&mut mesh.points, relaxation.at);
    if !mesh.is_valid() {
        mesh.points = before;
    }
}
