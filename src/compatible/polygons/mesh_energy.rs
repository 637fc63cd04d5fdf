//! Cost of a mesh, the weighted sum of its face costs, as a function of everything that may move:
//! inner vertices in both designs, and boundary vertices that slide along the outlines.
//!
//! Unknowns are the displacements of the inner vertices (first design x, first y, second x, second
//! y), then the slide of each sliding vertex.

use super::face_cost;
use super::pair_mesh::PairMesh;
use crate::correspondence::BoundaryCurve;
use crate::geometry::DVec2;
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// Boundary vertex that slides along both outlines, by half of its slide in each design, in
/// opposite directions.
#[derive(Clone, Debug)]
pub(super) struct SlidingVertex<'a> {
    /// Index of the vertex.
    pub(super) vertex: u32,
    /// Outline of each design.
    pub(super) curves: [&'a BoundaryCurve; 2],
    /// Position on each outline, in curve units (the whole curve is 1).
    pub(super) places: [f64; 2],
}

/// Change of the position in each design per unit of slide (derived: half each, so that both
/// designs are treated alike).
const SLIDE_SHARES: [f64; 2] = [-0.5, 0.5];

impl SlidingVertex<'_> {
    /// Moves the vertex by a slide.
    pub(super) fn slide(&mut self, by: f64) {
        self.places = [0, 1].map(|design| self.place(by, design));
    }

    /// Position in one design after a slide.
    fn place(&self, by: f64, design: usize) -> f64 {
        self.places[design] + SLIDE_SHARES[design] * by
    }
}

/// Cost of a mesh as a function of its unknowns, with scratch memory for evaluations.
pub(super) struct MeshEnergy<'a> {
    mesh: &'a PairMesh,
    /// Faces with their weights.
    pub(super) faces: Vec<([u32; 3], f64)>,
    /// The inner vertices, ascending.
    pub(super) inner: Vec<u32>,
    sliders: &'a [SlidingVertex<'a>],
    /// Scale of each design relative to its curves.
    scales: [f64; 2],
    /// Weight of the area-change term.
    area: f64,
    /// Scratch: vertices for the current unknowns, and gradients with respect to them.
    current: [Vec<DVec2>; 2],
    gradients: [Vec<DVec2>; 2],
}

impl<'a> MeshEnergy<'a> {
    /// Cost as a function of the inner vertices only.
    pub(super) fn of_inner_vertices(mesh: &'a PairMesh, area: f64) -> Self {
        Self::new(mesh, &[], [1.0; 2], area)
    }

    /// Cost as a function of the inner vertices and the sliding ones.
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
            current: mesh.points.clone(),
            gradients: [zero.clone(), zero],
            mesh,
            sliders,
            scales,
            area,
        }
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        4 * self.inner.len() + self.sliders.len()
    }

    /// Takes at most `steps` steps downhill; returns the vertices and the slides reached.
    pub(super) fn minimised(
        mut self,
        steps: usize,
        precondition: impl FnMut(&mut [f64]),
        progress: &dyn Progress,
    ) -> ([Vec<DVec2>; 2], Vec<f64>) {
        let mut x = vec![0.0; self.unknowns()];
        let energy = |x: &[f64], gradient: &mut [f64]| self.energy(x, gradient);
        minimise(&mut x, steps, 1e-5, precondition, energy, progress);
        self.apply(&x);
        // The slides are the last unknowns.
        (self.current, x.split_off(4 * self.inner.len()))
    }

    /// Derivative of a sliding vertex's position in one design with respect to its slide.
    pub(super) fn velocity(&self, slider: usize, by: f64, design: usize) -> DVec2 {
        let slider = &self.sliders[slider];
        let along = slider.curves[design].velocity_at(slider.place(by, design));
        along * (SLIDE_SHARES[design] * self.scales[design])
    }

    /// Moves the vertices to where the unknowns `x` put them.
    fn apply(&mut self, x: &[f64]) {
        let n = self.inner.len();
        for d in 0..2 {
            let start = &self.mesh.points[d];
            let (along_x, along_y) = x[2 * d * n..2 * (d + 1) * n].split_at(n);
            for (i, &v) in self.inner.iter().enumerate() {
                let by = DVec2::new(along_x[i], along_y[i]);
                self.current[d][v as usize] = start[v as usize] + by;
            }
            for (slider, &by) in self.sliders.iter().zip(&x[4 * n..]) {
                let v = slider.vertex as usize;
                self.current[d][v] = if by == 0.0 {
                    start[v] // exact, so that the start stays valid
                } else {
                    slider.curves[d].point_at(slider.place(by, d)) * self.scales[d]
                };
            }
        }
    }

    /// Returns the cost at `x` and fills its gradient; infinite if a face is not positive.
    fn energy(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        self.apply(x);
        for gradients in &mut self.gradients {
            gradients.fill(DVec2::ZERO);
        }
        let mut total = 0.0;
        for &(face, weight) in &self.faces {
            let [p, q] = [0, 1].map(|d| face.map(|v| self.current[d][v as usize]));
            // No gradient is needed: the line search only shortens its step.
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
            // Chain rule: one slide moves the vertex in both designs.
            let along = |d: usize| self.gradients[d][v].dot(self.velocity(i, by, d));
            gradient[4 * n + i] = along(0) + along(1);
        }
        total
    }
}

/// Returns the faces with weights that add up to 1. Half of a weight is the face's mean share of
/// both areas, and half is the same for all faces.
pub(super) fn weighted_faces(mesh: &PairMesh) -> Vec<([u32; 3], f64)> {
    let areas = |face| mesh.corners(face).map(face_cost::twice_area);
    let mut total = [0.0; 2];
    let mut count = 0.0;
    for face in mesh.faces() {
        let area = areas(face);
        total = [total[0] + area[0], total[1] + area[1]];
        count += 1.0;
    }
    // By area alone, the small faces of details would hardly count.
    let weight = |face| {
        let area = areas(face);
        0.25 * (area[0] / total[0] + area[1] / total[1]) + 0.5 / count
    };
    mesh.faces().map(|face| (face, weight(face))).collect()
}
