//! Removes folds of a mesh in its second embedding by minimising Σ area · (tr(JᵀJ) + 1 + det²) /
//! χ(det) over all faces (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021,
//! "Foldover-free maps in 50 lines of code"). J is the Jacobian of a face and det its determinant.
//! χ(det) = (det + √(ε² + det²)) / 2 is positive for either sign of det; ε shrinks from round to
//! round as folds disappear.

use super::face_cost;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::geometry::{DMat2, DVec2};
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// Minimum of ε, in units of the area-weighted mean determinant (heuristic: a smaller ε allows
/// thinner faces but needs shorter descent steps).
const MIN_EPSILON: f64 = 1e-3;
/// Maximum number of descent steps in a round of [`untangle`], during which ε is fixed (heuristic:
/// a new ε is better as soon as the worst face has moved).
const STEPS: usize = 30;

/// Face with the quantities from which its energy is computed.
struct UntangleFace {
    /// Vertex indices of the corners.
    corners: [usize; 3],
    /// Matrix by which the face's edge vectors in the target are multiplied to give its Jacobian.
    /// It is scaled so that the mean determinant of the Jacobians, weighted by the faces' areas in
    /// the source, is 1.
    from_edges: DMat2,
    /// Area of the face in the source, as a fraction of the source's total area.
    share: f64,
}

impl UntangleFace {
    /// Jacobian of the affine map of this face from source to target, where `at` gives the target
    /// positions of the vertices.
    fn jacobian(&self, at: impl Fn(usize) -> DVec2) -> DMat2 {
        let [a, b, c] = self.corners.map(at);
        DMat2::from_cols(b - a, c - a) * self.from_edges
    }
}

/// Returns each face with the quantities from which its energy is computed.
fn untangle_faces(mesh: &PairMesh) -> Vec<UntangleFace> {
    let twice_areas = |d: usize| {
        mesh.faces()
            .map(move |f| face_cost::twice_area(mesh.corners(f)[d]))
    };
    let total: f64 = twice_areas(0).sum();
    // Folded faces have negative area, so the sum of the areas in the target is the area of the
    // target polygon, wherever the inner vertices lie.
    let scale = (total / twice_areas(1).sum::<f64>()).sqrt();
    let prepared = |face: [u32; 3]| {
        let [p, _] = mesh.corners(face);
        let edges = DMat2::from_cols(p[1] - p[0], p[2] - p[0]);
        UntangleFace {
            corners: face.map(|v| v as usize),
            from_edges: edges.inverse() * scale,
            share: edges.determinant() / total,
        }
    };
    mesh.faces().map(prepared).collect()
}

/// Runs one round of minimisation with a fixed ε, which moves the inner vertices in the second
/// embedding. A cancel ends the round early. Returns whether any vertex moved.
pub(super) fn untangle(mesh: &mut PairMesh, progress: &dyn Progress) -> bool {
    let faces = untangle_faces(mesh);
    let n = mesh.fixed;
    let start = mesh.points[1].clone();
    let smallest_det = faces
        .iter()
        .map(|face| face.jacobian(|v| start[v]).determinant())
        .fold(f64::INFINITY, f64::min);
    // ε follows the most negative determinant, with the factor 1/5 of the paper's own code.
    let epsilon = MIN_EPSILON.hypot(0.2 * smallest_det.min(0.0));
    let movable: Vec<u32> = (n as u32..start.len() as u32).collect();
    let Some(mut springs) = springs(&faces, &movable, progress) else {
        return false;
    };
    let mut x = vec![0.0; 2 * (start.len() - n)];
    let precondition = |forces: &mut [f64]| springs.solve(forces);
    let energy = |x: &[f64], gradient: &mut [f64]| energy(&faces, &start, n, epsilon, x, gradient);
    minimise(&mut x, STEPS, 1e-5, precondition, energy, progress);
    let (along_x, along_y) = x.split_at(start.len() - n);
    for (i, point) in mesh.points[1][n..].iter_mut().enumerate() {
        *point += DVec2::new(along_x[i], along_y[i]);
    }
    // If no vertex has moved, another round would not move any either.
    mesh.points[1] != start
}

/// Returns springs that precondition the minimisation of the energy. Their stiffness is, up to a
/// factor, the second derivative of the energy where no face is distorted. `None` if their matrix
/// is not positive definite, or on a cancel.
fn springs(faces: &[UntangleFace], movable: &[u32], progress: &dyn Progress) -> Option<Springs> {
    let springs = faces.iter().flat_map(|face| {
        let weight = 2.0 * face.share;
        // The energy |J|² of a face is a sum of its squared edge lengths, weighted by the
        // cotangents of the opposite corners.
        let m = face.from_edges * face.from_edges.transpose();
        let (ab, ac, bc) = (
            m.x_axis.x + m.y_axis.x,
            m.y_axis.y + m.y_axis.x,
            -m.y_axis.x,
        );
        let [a, b, c] = face.corners.map(|v| v as u32);
        [([a, b], ab), ([a, c], ac), ([b, c], bc)].map(|(ends, s)| (ends, weight * s))
    });
    Springs::new(movable, springs, progress)
}

/// Returns the energy at the displacements `x` of the inner vertices and writes its gradient. `x`
/// lists all x components, then all y components.
fn energy(
    faces: &[UntangleFace],
    start: &[DVec2],
    fixed: usize,
    epsilon: f64,
    x: &[f64],
    gradient: &mut [f64],
) -> f64 {
    let n = start.len() - fixed;
    let at = |v: usize| match v.checked_sub(fixed) {
        None => start[v],
        Some(i) => start[v] + DVec2::new(x[i], x[n + i]),
    };
    gradient.fill(0.0);
    let mut total = 0.0;
    for face in faces {
        let j = face.jacobian(at);
        let (value, by_jacobian) = density(j, epsilon);
        total += face.share * value;
        // With the matrix of edge vectors b − a and c − a, J = edges · from_edges. Moving the
        // corner a changes both edge vectors by the opposite of its displacement.
        let by_edges = by_jacobian * face.from_edges.transpose() * face.share;
        let corners = [
            -(by_edges.x_axis + by_edges.y_axis),
            by_edges.x_axis,
            by_edges.y_axis,
        ];
        for (v, g) in face.corners.into_iter().zip(corners) {
            if let Some(i) = v.checked_sub(fixed) {
                gradient[i] += g.x;
                gradient[n + i] += g.y;
            }
        }
    }
    total
}

/// Computes χ = (det + √(ε² + det²)) / 2, which is positive for either sign of `det`.
fn chi(det: f64, epsilon: f64) -> f64 {
    let root = (epsilon * epsilon + det * det).sqrt();
    // For det < 0 the sum det + √(ε² + det²) cancels to zero in floating point. The equivalent form
    // in the second branch does not.
    if det > 0.0 {
        0.5 * (det + root)
    } else {
        0.5 * epsilon * epsilon / (root - det)
    }
}

/// Returns the energy density (tr(JᵀJ) + 1 + det²) / χ(det) and its derivative with respect to J.
fn density(j: DMat2, epsilon: f64) -> (f64, DMat2) {
    let det = j.determinant();
    let root = (epsilon * epsilon + det * det).sqrt();
    let chi = chi(det, epsilon);
    // Derivative of the determinant with respect to J.
    let cofactor = DMat2::from_cols(
        DVec2::new(j.y_axis.y, -j.y_axis.x),
        DVec2::new(-j.x_axis.y, j.x_axis.x),
    );
    let square = j.x_axis.length_squared() + j.y_axis.length_squared();
    let value = (square + 1.0 + det * det) / chi;
    // The derivative of χ with respect to det is χ / √(ε² + det²).
    let by_det = (2.0 * det - value * chi / root) / chi;
    (value, j * (2.0 / chi) + cofactor * by_det)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_has_its_derivative_for_both_signs() {
        for j in [
            DMat2::from_cols(DVec2::new(1.0, 0.2), DVec2::new(-0.3, 0.8)),
            DMat2::from_cols(DVec2::new(1.0, 0.2), DVec2::new(0.3, -0.8)),
        ] {
            let (_, by_j) = density(j, 0.3);
            let h = 1e-6;
            for k in 0..4 {
                let moved = |by: f64| {
                    let mut entries = j.to_cols_array();
                    entries[k] += by;
                    density(DMat2::from_cols_array(&entries), 0.3).0
                };
                let slow = (moved(h) - moved(-h)) / (2.0 * h);
                let fast = by_j.to_cols_array()[k];
                assert!(
                    (slow - fast).abs() < 1e-6 * (1.0 + slow.abs()),
                    "{slow} {fast}"
                );
            }
        }
    }

    #[test]
    fn a_far_negative_determinant_stays_finite() {
        let flipped = DMat2::from_diagonal(DVec2::new(1e4, -1e4));
        assert!(density(flipped, 1e-3).0.is_finite());
    }
}
