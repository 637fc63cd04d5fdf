//! Cost of a mesh (the weighted sum of its face costs) as a function of everything that may move:
//! inner vertices in both designs, and boundary vertices that slide along the outlines.
//!
//! The unknowns are the displacements of the inner vertices (all x in the first design, all y in
//! the first, all x in the second, all y in the second), followed by one slide (a displacement
//! along the outlines) for each sliding vertex.

use super::face_cost;
use super::pair_mesh::PairMesh;
use crate::correspondence::BoundaryCurve;
use crate::geometry::DVec2;
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// Boundary vertex that slides along the outlines. A slide moves it by half the amount in each
/// design, in opposite directions.
#[derive(Clone, Debug)]
pub(super) struct SlidingVertex<'a> {
    /// Index of the vertex in the mesh.
    pub(super) vertex: u32,
    /// Outline along which the vertex slides, in each design.
    pub(super) curves: [&'a BoundaryCurve; 2],
    /// Position of the vertex along each outline, in curve units (the whole outline is 1).
    pub(super) places: [f64; 2],
}

/// Change of a sliding vertex's position along the outline of each design, per unit of slide
/// (derived: half in each design, so that both are treated alike).
const SLIDE_SHARES: [f64; 2] = [-0.5, 0.5];

impl SlidingVertex<'_> {
    /// Moves the vertex in both designs by the slide `by`.
    pub(super) fn slide(&mut self, by: f64) {
        self.places = [0, 1].map(|design| self.place(by, design));
    }

    /// Position of the vertex along the outline of one design after the slide `by`.
    fn place(&self, by: f64, design: usize) -> f64 {
        self.places[design] + SLIDE_SHARES[design] * by
    }
}

/// Cost of a mesh as a function of the unknowns, with scratch memory for its evaluation.
pub(super) struct MeshEnergy<'a> {
    mesh: &'a PairMesh,
    /// Faces as triples of vertex indices, each with its weight.
    pub(super) faces: Vec<([u32; 3], f64)>,
    /// Indices of the inner vertices, ascending.
    pub(super) inner: Vec<u32>,
    sliders: &'a [SlidingVertex<'a>],
    /// For each design, the factor that converts coordinates of its outlines to coordinates of the
    /// mesh.
    scales: [f64; 2],
    /// Weight of the term for the change of area in the face cost.
    area: f64,
    /// Scratch memory: vertex positions for the current unknowns, and the gradients with respect to
    /// these positions.
    current: [Vec<DVec2>; 2],
    gradients: [Vec<DVec2>; 2],
}

impl<'a> MeshEnergy<'a> {
    /// Creates the cost as a function of the inner vertices only. `area` is the weight of the term
    /// for the change of area in the face cost.
    pub(super) fn of_inner_vertices(mesh: &'a PairMesh, area: f64) -> Self {
        Self::new(mesh, &[], [1.0; 2], area)
    }

    /// Creates the cost as a function of the inner vertices and of the sliding vertices `sliders`.
    pub(super) fn new(
        mesh: &'a PairMesh,
        sliders: &'a [SlidingVertex<'a>],
        scales: [f64; 2],
        area: f64,
    ) -> Self {
        let zero = vec![DVec2::ZERO; mesh.points[0].len()];
        Self {
            faces: weighted_faces(mesh),
            inner: mesh.steiner_vertices(),
            current: mesh.points.clone(),
            gradients: [zero.clone(), zero],
            mesh,
            sliders,
            scales,
            area,
        }
    }

    /// Number of unknowns: four for each inner vertex and one for each sliding vertex.
    pub(super) fn unknown_count(&self) -> usize {
        4 * self.inner.len() + self.sliders.len()
    }

    /// Lowers the cost in at most `steps` descent steps. Returns the vertex positions in both
    /// designs and the slides.
    pub(super) fn minimise(
        mut self,
        steps: usize,
        precondition: impl FnMut(&mut [f64]),
        progress: &dyn Progress,
    ) -> ([Vec<DVec2>; 2], Vec<f64>) {
        let mut x = vec![0.0; self.unknown_count()];
        let energy = |x: &[f64], gradient: &mut [f64]| self.energy(x, gradient);
        minimise(&mut x, steps, 1e-5, precondition, energy, progress);
        self.apply(&x);
        // The unknowns of the inner vertices come first, four for each vertex. The rest are the
        // slides, one for each sliding vertex.
        (self.current, x.split_off(4 * self.inner.len()))
    }

    /// Derivative of the position of a sliding vertex in one design with respect to its slide (its
    /// displacement along the outlines). The derivative is taken where the slide is `by`.
    pub(super) fn velocity(&self, slider: usize, by: f64, design: usize) -> DVec2 {
        let slider = &self.sliders[slider];
        let along = slider.curves[design].velocity_at(slider.place(by, design));
        along * (SLIDE_SHARES[design] * self.scales[design])
    }

    /// Writes the vertex positions for the unknowns `x` to `current`.
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

    /// Returns the cost at the unknowns `x` and writes its gradient to `gradient`. If a face is not
    /// positive, returns infinity and writes no gradient.
    fn energy(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        self.apply(x);
        for gradients in &mut self.gradients {
            gradients.fill(DVec2::ZERO);
        }
        let mut total = 0.0;
        for &(face, weight) in &self.faces {
            let [p, q] = [0, 1].map(|d| face.map(|v| self.current[d][v as usize]));
            // After an infinite cost, the line search only shortens its step and reads no gradient.
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
            // A slide moves the vertex in both designs, so the derivatives in both add up (chain
            // rule).
            let along = |d: usize| self.gradients[d][v].dot(self.velocity(i, by, d));
            gradient[4 * n + i] = along(0) + along(1);
        }
        total
    }
}

/// Returns the faces with weights that add up to 1. One half of the total weight is distributed in
/// proportion to the face's mean share of the area in both designs, the other half equally.
pub(super) fn weighted_faces(mesh: &PairMesh) -> Vec<([u32; 3], f64)> {
    let areas = |face| mesh.corners(face).map(face_cost::twice_area);
    let mut total = [0.0; 2];
    let mut count = 0.0;
    for face in mesh.faces() {
        let area = areas(face);
        total = [total[0] + area[0], total[1] + area[1]];
        count += 1.0;
    }
    // With weights by area alone, the small faces of details would hardly count.
    let weight = |face| {
        let area = areas(face);
        0.25 * (area[0] / total[0] + area[1] / total[1]) + 0.5 / count
    };
    mesh.faces().map(|face| (face, weight(face))).collect()
}
