//! Fold-overs removed by minimising
//! Σ area · (tr(JᵀJ) + 1 + det²) / χ(det) with a shrinking ε (Garanzha,
//! Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021, "Foldover-free maps in
//! 50 lines of code").

use super::face_cost;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::geometry::{DMat2, DVec2};
use crate::numerics::lbfgs::minimise;
use crate::work::progress::Progress;

/// Least ε, in units of the mean determinant. A smaller one lets thinner faces
/// be, and makes a steeper barrier, which takes shorter steps.
const LEAST_EPSILON: f64 = 1e-3;
/// Steps in each round of one ε: the next ε is the better one as soon as the
/// worst face has moved.
const STEPS: usize = 30;

/// A face as the energy sees it.
struct UntangleFace {
    corners: [usize; 3],
    /// From edges in the target to the Jacobian, scaled to a mean
    /// determinant of one.
    from_edges: DMat2,
    share: f64,
}

impl UntangleFace {
    fn jacobian(&self, at: impl Fn(usize) -> DVec2) -> DMat2 {
        let [a, b, c] = self.corners.map(at);
        DMat2::from_cols(b - a, c - a) * self.from_edges
    }
}

fn pieces(mesh: &PairMesh) -> Vec<UntangleFace> {
    let doubled = |d: usize| {
        mesh.faces()
            .map(move |f| face_cost::twice_area(mesh.corners(f)[d]))
    };
    let total: f64 = doubled(0).sum();
    // Folds cancel in the sum: it is the area of the target's polygon,
    // whatever its inside does yet.
    let scale = (total / doubled(1).sum::<f64>()).sqrt();
    let piece = |face: [u32; 3]| {
        let [p, _] = mesh.corners(face);
        let edges = DMat2::from_cols(p[1] - p[0], p[2] - p[0]);
        UntangleFace {
            corners: face.map(|v| v as usize),
            from_edges: edges.inverse() * scale,
            share: edges.determinant() / total,
        }
    };
    mesh.faces().map(piece).collect()
}

/// One round at one ε, ended early by a cancel; `false` if it moved nothing.
pub(super) fn untangle(mesh: &mut PairMesh, progress: &dyn Progress) -> bool {
    let pieces = pieces(mesh);
    let n = mesh.fixed;
    let start = mesh.points[1].clone();
    let least = pieces
        .iter()
        .map(|piece| piece.jacobian(|v| start[v]).determinant())
        .fold(f64::INFINITY, f64::min);
    // A fifth of the worst fold, as in the paper's own code.
    let epsilon = LEAST_EPSILON.hypot(0.2 * least.min(0.0));
    let movable: Vec<u32> = (n as u32..start.len() as u32).collect();
    let Some(mut springs) = springs(&pieces, &movable, progress) else {
        return false;
    };
    let mut x = vec![0.0; 2 * (start.len() - n)];
    let precondition = |forces: &mut [f64]| springs.solve(forces);
    let energy = |x: &[f64], gradient: &mut [f64]| energy(&pieces, &start, n, epsilon, x, gradient);
    minimise(&mut x, STEPS, 1e-5, precondition, energy, progress);
    let (along_x, along_y) = x.split_at(start.len() - n);
    for (i, point) in mesh.points[1][n..].iter_mut().enumerate() {
        *point += DVec2::new(along_x[i], along_y[i]);
    }
    // Nothing moved: the same round again would move nothing.
    mesh.points[1] != start
}

/// The curvature of the energy near no distortion, up to a factor.
fn springs(pieces: &[UntangleFace], movable: &[u32], progress: &dyn Progress) -> Option<Springs> {
    let springs = pieces.iter().flat_map(|piece| {
        let weight = 2.0 * piece.share;
        // |J|² is a sum over edges of the corners' cotangents.
        let m = piece.from_edges * piece.from_edges.transpose();
        let (ab, ac, bc) = (
            m.x_axis.x + m.y_axis.x,
            m.y_axis.y + m.y_axis.x,
            -m.y_axis.x,
        );
        let [a, b, c] = piece.corners.map(|v| v as u32);
        [([a, b], ab), ([a, c], ac), ([b, c], bc)].map(|(ends, s)| (ends, weight * s))
    });
    Springs::new(movable, springs, progress)
}

fn energy(
    pieces: &[UntangleFace],
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
    for piece in pieces {
        let j = piece.jacobian(at);
        let (value, by_jacobian) = density(j, epsilon);
        total += piece.share * value;
        // J = edges · from_edges, and the first corner moves both edges back.
        let by_edges = by_jacobian * piece.from_edges.transpose() * piece.share;
        let corners = [
            -(by_edges.x_axis + by_edges.y_axis),
            by_edges.x_axis,
            by_edges.y_axis,
        ];
        for (v, g) in piece.corners.into_iter().zip(corners) {
            if let Some(i) = v.checked_sub(fixed) {
                gradient[i] += g.x;
                gradient[n + i] += g.y;
            }
        }
    }
    total
}

/// (det + √(ε² + det²)) / 2: positive for either sign.
fn chi(det: f64, epsilon: f64) -> f64 {
    let root = (epsilon * epsilon + det * det).sqrt();
    // The textbook form for both signs cancels to zero where det < 0.
    if det > 0.0 {
        0.5 * (det + root)
    } else {
        0.5 * epsilon * epsilon / (root - det)
    }
}

/// (tr(JᵀJ) + 1 + det²) / χ(det) and its derivative by J.
fn density(j: DMat2, epsilon: f64) -> (f64, DMat2) {
    let det = j.determinant();
    let root = (epsilon * epsilon + det * det).sqrt();
    let chi = chi(det, epsilon);
    // The derivative of the determinant.
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
