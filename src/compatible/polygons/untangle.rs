//! Removes folds by minimising Σ area · (tr(JᵀJ) + 1 + det²) / χ(det) with a shrinking ε (Garanzha,
//! Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021, "Foldover-free maps in 50 lines of code").

use super::face_cost;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::geometry::{DMat2, DVec2};
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// Smallest ε, in units of the mean determinant (heuristic: a smaller one allows thinner faces but
/// needs shorter steps).
const MIN_EPSILON: f64 = 1e-3;
/// Descent steps for each ε (heuristic: the next ε is better as soon as the worst face has moved).
const STEPS: usize = 30;

/// Face with the quantities that the energy needs.
struct UntangleFace {
    /// Indices of the corners.
    corners: [usize; 3],
    /// Map from edge vectors in the target to the Jacobian, scaled so that the mean determinant is
    /// 1.
    from_edges: DMat2,
    /// Share of the source's area.
    share: f64,
}

impl UntangleFace {
    /// Jacobian of the map from source to target, for the target positions `at`.
    fn jacobian(&self, at: impl Fn(usize) -> DVec2) -> DMat2 {
        let [a, b, c] = self.corners.map(at);
        DMat2::from_cols(b - a, c - a) * self.from_edges
    }
}

/// Prepares all faces of a mesh.
fn untangle_faces(mesh: &PairMesh) -> Vec<UntangleFace> {
    let twice_areas = |d: usize| {
        mesh.faces()
            .map(move |f| face_cost::twice_area(mesh.corners(f)[d]))
    };
    let total: f64 = twice_areas(0).sum();
    // Folded faces cancel in the sum, so it is the area of the target polygon whatever its
    // interior.
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

/// Runs one round with one ε; a cancel ends it early. Returns whether any vertex moved.
pub(super) fn untangle(mesh: &mut PairMesh, progress: &dyn Progress) -> bool {
    let faces = untangle_faces(mesh);
    let n = mesh.fixed;
    let start = mesh.points[1].clone();
    let smallest_det = faces
        .iter()
        .map(|face| face.jacobian(|v| start[v]).determinant())
        .fold(f64::INFINITY, f64::min);
    // One fifth of the worst fold, as in the paper's own code.
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
    // If nothing moved, another round would move nothing either.
    mesh.points[1] != start
}

/// Springs with the curvature of the energy near an undistorted map, up to a factor.
fn springs(faces: &[UntangleFace], movable: &[u32], progress: &dyn Progress) -> Option<Springs> {
    let springs = faces.iter().flat_map(|face| {
        let weight = 2.0 * face.share;
        // |J|² is a sum of squared edges, weighted by the cotangents of the opposite corners.
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

/// Returns the energy at the displacements `x` and fills its gradient.
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
        // J = edges · from_edges; the first corner moves both edges, in the opposite direction.
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

/// χ = (det + √(ε² + det²)) / 2, which is positive for either sign of `det`.
fn chi(det: f64, epsilon: f64) -> f64 {
    let root = (epsilon * epsilon + det * det).sqrt();
    // For det < 0 the textbook form cancels to zero; the other form does not.
    if det > 0.0 {
        0.5 * (det + root)
    } else {
        0.5 * epsilon * epsilon / (root - det)
    }
}

/// Returns (tr(JᵀJ) + 1 + det²) / χ(det) and its derivative with respect to J.
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
    // χ′ = χ / √(ε² + det²).
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
