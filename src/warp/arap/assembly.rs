//! Local maps, weights and the matrix of the energy.
//!
//! W_T = w_A I one-sided; W_T = ½ (w_A I + w_B (MᵀM)⁻¹) symmetric, which
//! makes one matrix of the energies of both directions: (MᵀM)⁻¹ takes the gradients
//! in the source to what they are in the target. A bar that lies in no
//! face is a two-point element: its local map is the similarity that takes
//! the bar from source to target, and with area weights its energy is
//! ½ |Δv − e(t)|², an area like length²/2 times a relative stretch squared.

use super::angles::{self, choose_turns};
use super::options::{ArapError, ArapOptions, FaceWeights};
use super::straight_sides::OutlineConstraints;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, twice_signed_area};
use crate::numerics::SymmetricMatrix;
use crate::warp::part_path::{centroid, rotation};

/// One face: its local map and W g for its second and third vertex; the first
/// has minus their sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceMap {
    pub map: PolarDecomposition,
    /// Gradients of the hat functions of the second and third vertex.
    pub gradients: DMat2,
    /// W times them.
    pub weighted: DMat2,
    /// Gradients of the same hat functions in the target.
    pub target_gradients: DMat2,
    /// What |∇|² counts in source and target: W is the sum of both.
    pub weights: [f64; 2],
}

impl FaceMap {
    /// Between faces with these corners, in source and target.
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

    /// What it adds to K, of each two of its vertices. Summed over both designs, it stays
    /// positive where W does not: of a mesh of two icons, some faces were 1e14 times as
    /// long as wide in one, and what was left of the smaller stiffness was rounding.
    fn energy(&self) -> [[f64; 3]; 3] {
        let sides = [self.gradients, self.target_gradients].map(with_first);
        let of = |i: usize, j: usize| {
            let side = |s: usize| self.weights[s] * sides[s][i].dot(sides[s][j]);
            side(0) + side(1)
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| of(i, j)))
    }
}

/// One bar in no face, or one edge of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementMap {
    pub ends: [u32; 2],
    /// The bar's vector in the source.
    pub vector: DVec2,
    pub angle: f64,
    /// Length in the target by length in the source.
    pub stretch: f64,
    pub stiffness: f64,
}

/// Everything that the energy is made of, independent of t.
#[derive(Clone, Debug)]
pub(super) struct LocalMaps {
    pub faces: Vec<FaceMap>,
    pub elements: Vec<ElementMap>,
    /// How many dual components the faces have.
    pub part_count: usize,
    /// The rotation of the design as a whole.
    pub whole_angle: f64,
    /// Fixed vertex masses: the mean of the normalised lumped areas.
    pub masses: Vec<f64>,
    /// What the weight of each face is multiplied with; 1 beyond the list.
    pub stiffness: Vec<f64>,
}

impl LocalMaps {
    pub(super) fn new(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        lives: &[Option<TimeWindow>],
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
            best_fit_angle(mesh, &counted(mesh, &masses, lives)),
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

    /// With the weights of the faces multiplied by these numbers instead.
    pub(super) fn stiffened(mut self, by: &[f64]) -> Self {
        let before = std::mem::replace(&mut self.stiffness, by.to_vec());
        let factor = |of: &[f64], face: usize| of.get(face).copied().unwrap_or(1.0);
        for (k, face) in self.faces.iter_mut().enumerate() {
            let times = factor(by, k) / factor(&before, k);
            face.weighted *= times;
            face.weights = face.weights.map(|weight| weight * times);
        }
        self
    }

    /// With the angles of the film that is run backwards, turned the other
    /// way, instead of angles chosen anew.
    pub(super) fn turning_back(mut self, there: &Self) -> Self {
        for (face, other) in self.faces.iter_mut().zip(&there.faces) {
            face.map.angle = -other.map.angle;
        }
        for (element, other) in self.elements.iter_mut().zip(&there.elements) {
            element.angle = -other.angle;
        }
        self.whole_angle = -there.whole_angle;
        self
    }

    /// K, made regular by grounding one vertex of each connected component.
    /// The right-hand sides add up to zero over a component, so that a
    /// grounded vertex stays exactly where it is and the choice of the ground
    /// has no influence.
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
        outlined.hold(mesh, &diagonal, &mut matrix);
        matrix
    }

    /// K, which does not know where connected components are.
    pub(super) fn free_matrix(
        &self,
        mesh: &CompatibleMesh,
        outlined: OutlineConstraints,
    ) -> SymmetricMatrix {
        let (mut matrix, diagonal) = self.energy(mesh);
        outlined.hold(mesh, &diagonal, &mut matrix);
        matrix
    }

    /// What faces and bars give of K, and what of it stands on the diagonal.
    fn energy(&self, mesh: &CompatibleMesh) -> (SymmetricMatrix, Vec<f64>) {
        let n = mesh.source().len();
        // Six entries a face; three a bar, and one for the ground.
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

/// The gradients or weighted gradients of all three vertices.
pub(super) fn with_first(of_second_and_third: DMat2) -> [DVec2; 3] {
    let (second, third) = (of_second_and_third.x_axis, of_second_and_third.y_axis);
    [-second - third, second, third]
}

fn corners(points: &[DVec2], face: [u32; 3]) -> [DVec2; 3] {
    face.map(|v| points[v as usize])
}

fn edges([a, b, c]: [DVec2; 3]) -> DMat2 {
    DMat2::from_cols(b - a, c - a)
}

/// Columns: the gradients of the second and third hat function, which are the
/// rows of the inverse edge matrix.
fn gradients(corners: [DVec2; 3]) -> DMat2 {
    edges(corners).inverse().transpose()
}

/// M = D_Q D_P⁻¹.
fn local_map(mesh: &CompatibleMesh, face: [u32; 3]) -> DMat2 {
    edges(corners(mesh.target(), face)) * edges(corners(mesh.source(), face)).inverse()
}

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
    // The weight of a side is length²/2 or 1, and the element's |Δv − e|² is
    // divided by that side's length².
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

/// Areas of faces and, as length²/2, of elements; source, then target.
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

    /// The mean of both sides' shares of each face.
    fn face_masses(&self) -> Vec<f64> {
        let (a, b) = (self.total(0), self.total(1));
        let sides = self.faces[0].iter().zip(&self.faces[1]);
        sides.map(|(&p, &q)| 0.5 * (p / a + q / b)).collect()
    }

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

/// The masses without those of parts that are points in one of the designs:
/// they say nothing of how it turns.
fn counted(mesh: &CompatibleMesh, masses: &[f64], lives: &[Option<TimeWindow>]) -> Vec<f64> {
    if lives.iter().all(Option::is_none) {
        return masses.to_vec();
    }
    let is_point = |part: u32| lives.get(part as usize).is_some_and(Option::is_some);
    let parts = mesh.components();
    let each = masses.iter().zip(&parts);
    let counted: Vec<f64> = each
        .map(|(&m, &part)| if is_point(part) { 0.0 } else { m })
        .collect();
    if counted.iter().all(|&m| m == 0.0) {
        return masses.to_vec();
    }
    counted
}

/// The rotation that best takes the source onto the target, in (−π, π].
fn best_fit_angle(mesh: &CompatibleMesh, masses: &[f64]) -> f64 {
    let places = mesh.source().iter().zip(mesh.target());
    let places = places.map(|(&p, &q)| [p, q]);
    let centroids = centroid(places.clone(), masses);
    rotation(places.zip(masses.iter().copied()), centroids)
}
