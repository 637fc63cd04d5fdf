//! All that may move of a mesh, and the weighted sum of its faces' costs by
//! that: inner vertices freely in both designs, those of the outlines along
//! them where they slide.
//!
//! Unknowns are displacements of the inner vertices (first design x, first y,
//! second x, second y), then how far each slider slides.

use super::face_cost;
use super::pair_mesh::PairMesh;
use crate::correspondence::BoundaryCurve;
use crate::geometry::DVec2;
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// A vertex that slides along both outlines, half the way in either, against
/// each other.
#[derive(Clone, Debug)]
pub(super) struct SlidingVertex<'a> {
    pub(super) vertex: u32,
    pub(super) curves: [&'a BoundaryCurve; 2],
    /// Where it is on them.
    pub(super) places: [f64; 2],
}

/// By how much of a slide the place in each design changes.
const SHARES: [f64; 2] = [-0.5, 0.5];

impl SlidingVertex<'_> {
    /// Takes its place after it slid so far.
    pub(super) fn slide(&mut self, by: f64) {
        self.places = [0, 1].map(|design| self.place(by, design));
    }

    fn place(&self, by: f64, design: usize) -> f64 {
        self.places[design] + SHARES[design] * by
    }
}

pub(super) struct MeshEnergy<'a> {
    mesh: &'a PairMesh,
    /// Faces with their weights.
    pub(super) faces: Vec<([u32; 3], f64)>,
    /// The inner vertices, ascending.
    pub(super) inner: Vec<u32>,
    sliders: &'a [SlidingVertex<'a>],
    /// How many times as large as its curves each design is.
    scales: [f64; 2],
    /// What the change of area costs.
    area: f64,
    /// Scratch: the vertices and the cost's gradients by them.
    at: [Vec<DVec2>; 2],
    gradients: [Vec<DVec2>; 2],
}

impl<'a> MeshEnergy<'a> {
    /// Of the inner vertices alone.
    pub(super) fn of_inner(mesh: &'a PairMesh, area: f64) -> Self {
        Self::new(mesh, &[], [1.0; 2], area)
    }

    pub(super) fn new(
        mesh: &'a PairMesh,
        sliders: &'a [SlidingVertex<'a>],
        scales: [f64; 2],
        area: f64,
    ) -> Self {
        let zero = vec![DVec2::ZERO; mesh.points[0].len()];
        Self {
            faces: weighted_faces(mesh),
            inner: mesh.steiner(),
            at: mesh.points.clone(),
            gradients: [zero.clone(), zero],
            mesh,
            sliders,
            scales,
            area,
        }
    }

    pub(super) fn unknowns(&self) -> usize {
        4 * self.inner.len() + self.sliders.len()
    }

    /// At most so many steps downhill: where the vertices are then, and how
    /// far the sliders slid.
    pub(super) fn minimised(
        mut self,
        steps: usize,
        precondition: impl FnMut(&mut [f64]),
        progress: &dyn Progress,
    ) -> ([Vec<DVec2>; 2], Vec<f64>) {
        let mut x = vec![0.0; self.unknowns()];
        let energy = |x: &[f64], gradient: &mut [f64]| self.energy(x, gradient);
        minimise(&mut x, steps, 1e-5, precondition, energy, progress);
        self.place(&x);
        (self.at, x.split_off(4 * self.inner.len()))
    }

    /// How a slider's point moves in a design as it slides.
    pub(super) fn velocity(&self, slider: usize, by: f64, design: usize) -> DVec2 {
        let slider = &self.sliders[slider];
        let along = slider.curves[design].velocity_at(slider.place(by, design));
        along * (SHARES[design] * self.scales[design])
    }

    /// Puts the vertices where displacements bring them.
    fn place(&mut self, x: &[f64]) {
        let n = self.inner.len();
        for d in 0..2 {
            let start = &self.mesh.points[d];
            let (along_x, along_y) = x[2 * d * n..2 * (d + 1) * n].split_at(n);
            for (i, &v) in self.inner.iter().enumerate() {
                let by = DVec2::new(along_x[i], along_y[i]);
                self.at[d][v as usize] = start[v as usize] + by;
            }
            for (slider, &by) in self.sliders.iter().zip(&x[4 * n..]) {
                let v = slider.vertex as usize;
                self.at[d][v] = if by == 0.0 {
                    start[v] // exact, so that the start is as valid as it was
                } else {
                    slider.curves[d].point_at(slider.place(by, d)) * self.scales[d]
                };
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
            let Some(cost) = face_cost::evaluate(p, q, self.area) else {
                return f64::INFINITY;
            };
            total += weight * cost.value;
            for d in 0..2 {
                for (k, &v) in face.iter().enumerate() {
                    self.gradients[d][v as usize] += weight * cost.gradients[d][k];
                }
            }
        }
        let n = self.inner.len();
        for d in 0..2 {
            for (i, &v) in self.inner.iter().enumerate() {
                let g = self.gradients[d][v as usize];
                gradient[2 * d * n + i] = g.x;
                gradient[(2 * d + 1) * n + i] = g.y;
            }
        }
        for (i, slider) in self.sliders.iter().enumerate() {
            let (v, by) = (slider.vertex as usize, x[4 * n + i]);
            let along = |d: usize| self.gradients[d][v].dot(self.velocity(i, by, d));
            gradient[4 * n + i] = along(0) + along(1);
        }
        total
    }
}

/// Faces weighted half by their mean share of both areas, half alike.
pub(super) fn weighted_faces(mesh: &PairMesh) -> Vec<([u32; 3], f64)> {
    let areas = |face| mesh.corners(face).map(face_cost::twice_area);
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
