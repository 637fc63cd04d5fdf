//! Assembly of the energy: local maps, weights and the matrix K.
//!
//! With the weights w_A and w_B of a face in source and target and its local map M, the weight
//! matrix is W_T = w_A I in the one-sided energy and W_T = ½ (w_A I + w_B (MᵀM)⁻¹) in the symmetric
//! one. The factor (MᵀM)⁻¹ converts gradients in the source to gradients in the target, so that a
//! single matrix serves both directions.
//!
//! A bar that belongs to no face is a two-point element. Its local map is the similarity that takes
//! the bar from source to target. With area weights its energy is ½ |Δv − e(t)|², where Δv is the
//! vector between its ends and e(t) the vector that the local map requires. This corresponds to an
//! area of length²/2 times a squared relative stretch.

use super::angles::{self, choose_turns};
use super::options::{ArapError, ArapOptions, FaceWeights};
use super::straight_sides::OutlineConstraints;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, twice_signed_area};
use crate::numerics::SymmetricMatrix;
use crate::warp::part_path::{centroid, rotation};

/// Local map and weighted gradients of one face.
///
/// Gradients are stored for the second and third vertex; the first has minus their sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceMap {
    pub map: PolarDecomposition,
    /// Gradients, in the source, of the hat functions of the second and third vertex (columns).
    pub gradients: DMat2,
    /// The gradients in the source multiplied by the face's weight matrix W_T. The face's
    /// contribution to the right-hand sides is computed from them.
    pub weighted: DMat2,
    /// Gradients, in the target, of the hat functions of the second and third vertex (columns).
    pub target_gradients: DMat2,
    /// Factors of the two terms of the face's energy: the term with the gradients in the source and
    /// the term with the gradients in the target.
    pub weights: [f64; 2],
}

impl FaceMap {
    /// Combines the local map `map` of a face with its gradients. `sides` holds the corners of the
    /// face in source and target.
    fn new(map: PolarDecomposition, sides: [[DVec2; 3]; 2], weights: [f64; 2]) -> Self {
        let [gradients, target_gradients] = sides.map(gradients);
        let back = edges(sides[0]) * edges(sides[1]).inverse();
        Self {
            map,
            gradients,
            weighted: gradients * weights[0] + back * target_gradients * weights[1],
            target_gradients,
            weights,
        }
    }

    /// Returns the 3×3 contribution of the face to the stiffness matrix K of the energy.
    ///
    /// The contributions of source and target are computed separately and added. For extremely thin
    /// faces, the sum stays positive. If it were computed from the weight matrix W_T, rounding
    /// would destroy its smaller eigenvalue.
    fn energy(&self) -> [[f64; 3]; 3] {
        let sides = [self.gradients, self.target_gradients].map(all_gradients);
        let entry = |i: usize, j: usize| {
            let of_side = |s: usize| self.weights[s] * sides[s][i].dot(sides[s][j]);
            of_side(0) + of_side(1)
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }
}

/// Local map of a two-point element: a bar that belongs to no face, or a boundary edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementMap {
    /// Indices of the vertices at the two ends of the element.
    pub ends: [u32; 2],
    /// Vector in the source from the first end of the element to the second.
    pub vector: DVec2,
    /// Rotation of the element from source to target, in radians.
    pub angle: f64,
    /// Ratio of the element's length in the target to its length in the source.
    pub stretch: f64,
    /// Factor of |Δv − e(t)|² in the energy, where Δv is the vector between the element's ends and
    /// e(t) is the vector that it should have at t.
    pub stiffness: f64,
}

/// All quantities of the energy that do not depend on t: the local maps of faces, bars and boundary
/// edges, the vertex masses and the stiffness factors of the faces.
#[derive(Clone, Debug)]
pub(super) struct LocalMaps {
    pub faces: Vec<FaceMap>,
    /// Local maps of the bars, followed by those of the boundary edges.
    pub elements: Vec<ElementMap>,
    /// Number of edge-connected components of the faces.
    pub part_count: usize,
    /// Rotation of the whole design in radians.
    pub whole_angle: f64,
    /// Mass of each vertex: a third of the area of its faces plus half of the area of its bars,
    /// where a bar has the area length²/2. Masses are fractions of the total area, averaged over
    /// both designs.
    pub masses: Vec<f64>,
    /// For each face, the factor by which its weight in the energy is multiplied; 1 for faces
    /// beyond the end of the list.
    pub stiffness: Vec<f64>,
}

impl LocalMaps {
    /// Computes the local maps of a mesh, with rotation angles that are consistent across shared
    /// edges.
    pub(super) fn new(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        time_windows: &[Option<TimeWindow>],
    ) -> Result<Self, ArapError> {
        let areas = MeshAreas::of(mesh);
        let maps: Vec<DMat2> = mesh.faces().iter().map(|f| local_map(mesh, *f)).collect();
        let polars: Vec<PolarDecomposition> =
            maps.iter().map(|&m| PolarDecomposition::of(m)).collect();
        let mut face_angles: Vec<f64> = polars.iter().map(|p| p.angle).collect();
        angles::make_consistent(mesh.connectivity(), &mut face_angles)?;
        let part_of = mesh.connectivity().dual_components();
        let masses = areas.vertex_masses(mesh);
        let whole_angle = choose_turns(
            &mut face_angles,
            &areas.face_masses(),
            &part_of,
            best_fit_angle(mesh, &permanent_masses(mesh, &masses, time_windows)),
            &options.extra_turns,
        );
        let faces = (0..maps.len())
            .map(|f| {
                let weight = |area: f64| match &options.weights {
                    FaceWeights::Area => area,
                    FaceWeights::Uniform => 1.0,
                    FaceWeights::PerFace(each) => each[f],
                };
                let [source, target] = [0, 1].map(|side| weight(areas.faces[side][f]));
                let weights = match options.symmetric {
                    true => [0.5 * source, 0.5 * target],
                    false => [source, 0.0],
                };
                let map = PolarDecomposition {
                    angle: face_angles[f],
                    ..polars[f]
                };
                let sides = [mesh.source(), mesh.target()];
                FaceMap::new(map, sides.map(|at| corners(at, mesh.faces()[f])), weights)
            })
            .collect();
        let by_area = options.weights == FaceWeights::Area;
        let elements = mesh
            .elements()
            .iter()
            .map(|&ends| element_map(mesh, ends, whole_angle, by_area, options.symmetric))
            .collect();
        Ok(Self {
            faces,
            elements,
            part_count: part_of.iter().max().map_or(0, |&last| last as usize + 1),
            whole_angle,
            masses,
            stiffness: Vec::new(),
        })
    }

    /// Replaces the stiffness factors of the faces by `by`; faces beyond the end of `by` get the
    /// factor 1.
    pub(super) fn with_stiffness(mut self, by: &[f64]) -> Self {
        let before = std::mem::replace(&mut self.stiffness, by.to_vec());
        let factor = |stiffness: &[f64], face: usize| stiffness.get(face).copied().unwrap_or(1.0);
        for (k, face) in self.faces.iter_mut().enumerate() {
            let ratio = factor(by, k) / factor(&before, k);
            face.weighted *= ratio;
            face.weights = face.weights.map(|weight| weight * ratio);
        }
        self
    }

    /// Replaces all angles by the negated angles of `forward`, the interpolation in the other
    /// direction.
    pub(super) fn with_reversed_angles(mut self, forward: &Self) -> Self {
        for (face, other) in self.faces.iter_mut().zip(&forward.faces) {
            face.map.angle = -other.map.angle;
        }
        for (element, other) in self.elements.iter_mut().zip(&forward.elements) {
            element.angle = -other.angle;
        }
        self.whole_angle = -forward.whole_angle;
        self
    }

    /// Returns the stiffness matrix K of the energy with one vertex of each connected component
    /// grounded: the vertex's diagonal entry is increased, which makes K regular.
    ///
    /// The right-hand sides sum to zero over each component, so the solution is zero at the
    /// grounded vertex. Grounding another vertex would only translate the component.
    pub(super) fn matrix(
        &self,
        mesh: &CompatibleMesh,
        outlined: OutlineConstraints,
    ) -> SymmetricMatrix {
        let (mut matrix, diagonal) = self.energy(mesh);
        let components = mesh.components();
        let mut grounded = vec![false; diagonal.len()];
        for (v, &component) in components.iter().enumerate() {
            if !std::mem::replace(&mut grounded[component as usize], true) {
                matrix.add(v as u32, v as u32, diagonal[v]);
            }
        }
        outlined.add_to_matrix(mesh, &diagonal, &mut matrix);
        matrix
    }

    /// Returns the stiffness matrix K of the energy before a vertex of each component is grounded.
    /// This matrix is singular, because translating a component does not change the energy.
    pub(super) fn free_matrix(
        &self,
        mesh: &CompatibleMesh,
        outlined: OutlineConstraints,
    ) -> SymmetricMatrix {
        let (mut matrix, diagonal) = self.energy(mesh);
        outlined.add_to_matrix(mesh, &diagonal, &mut matrix);
        matrix
    }

    /// Returns the stiffness matrix K of the energy, summed over faces, bars and boundary edges,
    /// and the diagonal of K.
    fn energy(&self, mesh: &CompatibleMesh) -> (SymmetricMatrix, Vec<f64>) {
        let n = mesh.source().len();
        // Each face adds six entries, and each bar or boundary edge three. The capacity has a
        // fourth entry per bar or boundary edge, as room for the diagonal entries that
        // [`Self::matrix`] increases.
        let mut matrix = SymmetricMatrix::zero(n, 6 * self.faces.len() + 4 * self.elements.len());
        let mut diagonal = vec![0.0; n];
        for (face, map) in mesh.faces().iter().zip(&self.faces) {
            let energy = map.energy();
            for i in 0..3 {
                diagonal[face[i] as usize] += energy[i][i];
                for j in 0..=i {
                    matrix.add(face[i], face[j], energy[i][j]);
                }
            }
        }
        for element in &self.elements {
            let ([a, b], k) = (element.ends, element.stiffness);
            diagonal[a as usize] += k;
            diagonal[b as usize] += k;
            matrix.add(a, a, k);
            matrix.add(b, b, k);
            matrix.add(a, b, -k);
        }
        (matrix, diagonal)
    }
}

/// Returns the gradients of the three hat functions of a face, given those of the second and third
/// vertex.
pub(super) fn all_gradients(of_second_and_third: DMat2) -> [DVec2; 3] {
    let (second, third) = (of_second_and_third.x_axis, of_second_and_third.y_axis);
    [-second - third, second, third]
}

fn corners(points: &[DVec2], face: [u32; 3]) -> [DVec2; 3] {
    face.map(|v| points[v as usize])
}

/// Returns the edge matrix, with the edges from the first corner as columns.
fn edges([a, b, c]: [DVec2; 3]) -> DMat2 {
    DMat2::from_cols(b - a, c - a)
}

/// Returns the gradients of the hat functions of the second and third corner, as columns.
///
/// These gradients are the rows of the inverse edge matrix.
fn gradients(corners: [DVec2; 3]) -> DMat2 {
    edges(corners).inverse().transpose()
}

/// Returns the linear map M = D_Q D_P⁻¹ of a face from source to target, with its edge matrices D_P
/// in the source and D_Q in the target.
fn local_map(mesh: &CompatibleMesh, face: [u32; 3]) -> DMat2 {
    edges(corners(mesh.target(), face)) * edges(corners(mesh.source(), face)).inverse()
}

/// Returns the local map of a bar: the similarity that takes it from source to target. Of all
/// rotation angles that differ by whole turns, it has the one nearest to `whole_angle`.
fn element_map(
    mesh: &CompatibleMesh,
    ends: [u32; 2],
    whole_angle: f64,
    by_area: bool,
    symmetric: bool,
) -> ElementMap {
    let along = |points: &[DVec2]| points[ends[1] as usize] - points[ends[0] as usize];
    let (p, q) = (along(mesh.source()), along(mesh.target()));
    let (length_p, length_q) = (p.length_squared(), q.length_squared());
    // The energy is the squared relative error |Δv − e|² / length², multiplied by the bar's area
    // length²/2 with area weights and by 1 otherwise. The argument `length` is already squared.
    let side = |length: f64| if by_area { 0.5 } else { 1.0 / length };
    let stiffness = if symmetric {
        0.5 * (side(length_p) + side(length_q))
    } else {
        side(length_p)
    };
    ElementMap {
        ends,
        vector: p,
        angle: angles::nearest_branch(p.perp_dot(q).atan2(p.dot(q)), whole_angle),
        stretch: (length_q / length_p).sqrt(),
        stiffness,
    }
}

/// Areas of faces and bars in source and target. The area of a bar is length²/2.
struct MeshAreas {
    faces: [Vec<f64>; 2],
    elements: [Vec<f64>; 2],
}

impl MeshAreas {
    fn of(mesh: &CompatibleMesh) -> Self {
        let faces = |points: &[DVec2]| {
            let area = |f: &[u32; 3]| {
                let [a, b, c] = corners(points, *f);
                0.5 * twice_signed_area(a, b, c)
            };
            mesh.faces().iter().map(area).collect()
        };
        let elements = |points: &[DVec2]| {
            let area =
                |&[a, b]: &[u32; 2]| 0.5 * points[a as usize].distance_squared(points[b as usize]);
            mesh.elements().iter().map(area).collect()
        };
        Self {
            faces: [faces(mesh.source()), faces(mesh.target())],
            elements: [elements(mesh.source()), elements(mesh.target())],
        }
    }

    fn total(&self, side: usize) -> f64 {
        self.faces[side].iter().chain(&self.elements[side]).sum()
    }

    /// Returns the mass of each face: its fraction of the total area, averaged over both designs.
    fn face_masses(&self) -> Vec<f64> {
        let (a, b) = (self.total(0), self.total(1));
        let sides = self.faces[0].iter().zip(&self.faces[1]);
        sides.map(|(&p, &q)| 0.5 * (p / a + q / b)).collect()
    }

    /// Returns the mass of each vertex. The area of a face is divided equally among its corners,
    /// that of a bar between its ends.
    fn vertex_masses(&self, mesh: &CompatibleMesh) -> Vec<f64> {
        let (a, b) = (self.total(0), self.total(1));
        let mut masses = vec![0.0; mesh.source().len()];
        for (face, mass) in mesh.faces().iter().zip(self.face_masses()) {
            face.iter().for_each(|&v| masses[v as usize] += mass / 3.0);
        }
        let sides = self.elements[0].iter().zip(&self.elements[1]);
        for (bar, (&p, &q)) in mesh.elements().iter().zip(sides) {
            let mass = 0.5 * (p / a + q / b);
            bar.iter().for_each(|&v| masses[v as usize] += mass / 2.0);
        }
        masses
    }
}

/// Returns the vertex masses, with those of transient parts set to zero.
///
/// A part that is a point in one of the designs says nothing about the rotation of the whole
/// design. If all parts are transient, the masses are unchanged.
fn permanent_masses(
    mesh: &CompatibleMesh,
    masses: &[f64],
    time_windows: &[Option<TimeWindow>],
) -> Vec<f64> {
    if time_windows.iter().all(Option::is_none) {
        return masses.to_vec();
    }
    let is_point = |part: u32| time_windows.get(part as usize).is_some_and(Option::is_some);
    let parts = mesh.components();
    let vertices = masses.iter().zip(&parts);
    let permanent: Vec<f64> = vertices
        .map(|(&m, &part)| if is_point(part) { 0.0 } else { m })
        .collect();
    if permanent.iter().all(|&m| m == 0.0) {
        return masses.to_vec();
    }
    permanent
}

/// Returns the rotation that best fits the source vertices onto the target vertices, weighted by
/// `masses`; in radians, in [−π, π].
fn best_fit_angle(mesh: &CompatibleMesh, masses: &[f64]) -> f64 {
    let vertices = mesh.source().iter().zip(mesh.target());
    let pairs = vertices.map(|(&p, &q)| [p, q]);
    let centroids = centroid(pairs.clone(), masses);
    rotation(pairs.zip(masses.iter().copied()), centroids)
}
