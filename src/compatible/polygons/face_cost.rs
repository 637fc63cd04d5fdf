//! Cost of one face in its two embeddings, with gradients. A low cost means little distortion and
//! good angles.
//!
//! The cost is symmetric in the two designs. It is the sum of three terms: the fourth power of the
//! conformal distortion between the designs (Hormann, Greiner 2000), the squared shape term of the
//! face in each design (its squared edge lengths over its area), and a small term for the change of
//! area. The fourth power gives the worst faces more weight than a square would. The cost tends to
//! infinity as a face becomes flat in either design.

use crate::geometry::{DVec2, orient2d, twice_signed_area};

/// Corner positions of a face in one design.
pub(super) type FaceCorners = [DVec2; 3];

/// Default weight of the area-change term (heuristic: small, because parts do grow and shrink; not
/// 0, because otherwise one face could grow at the expense of another at no cost).
pub(super) const AREA_WEIGHT: f64 = 0.02;

/// Cost of a face, and its gradients with respect to the corner positions in source and target.
pub(super) struct FaceCost {
    pub(super) value: f64,
    pub(super) gradients: [FaceCorners; 2],
}

/// Twice the signed area of a face in one design, subject to rounding.
pub(super) fn twice_area(p: FaceCorners) -> f64 {
    twice_signed_area(p[0], p[1], p[2])
}

/// Shape term of a face in one design: the sum of its squared edge lengths over its area, scaled to
/// 1 for an equilateral triangle; infinite if the face is not positive.
pub(super) fn shape(p: FaceCorners) -> f64 {
    let det = twice_area(p);
    if det > 0.0 {
        squares(edges(p)) / (2.0 * 3f64.sqrt() * det)
    } else {
        f64::INFINITY
    }
}

/// Returns whether a face is positive in one design, by exact predicates.
pub(super) fn is_positive(p: FaceCorners) -> bool {
    orient2d(p[0], p[1], p[2]) > 0.0
}

/// Cost of a face with the corners `p` and `q` in the two designs, without gradients; infinite if
/// the face is not positive in both.
pub(super) fn value(p: FaceCorners, q: FaceCorners) -> f64 {
    evaluate(p, q, AREA_WEIGHT).map_or(f64::INFINITY, |cost| cost.value)
}

/// Cost of a face with the corners `p` and `q` in the two designs, with gradients; `None` if the
/// face is not positive in both. `area_weight` is the weight of the area-change term.
pub(super) fn evaluate(p: FaceCorners, q: FaceCorners, area_weight: f64) -> Option<FaceCost> {
    let det = [p, q].map(twice_area);
    if !(det[0] > 0.0 && det[1] > 0.0) {
        return None;
    }
    let e = [edges(p), edges(q)];
    let products = e.map(products);
    let inverse = det.map(|det| 1.0 / det);
    let both = 0.5 * inverse[0] * inverse[1];
    // Conformal distortion: (σ₁/σ₂ + σ₂/σ₁) / 2 = |J|² / (2 det J), where J is the Jacobian of the
    // affine map from the face in the source to the face in the target, and det J = det[1] /
    // det[0].
    let conformal = dirichlet(products[0], e[1]) * both;
    let squared = conformal * conformal;
    let ratios = [det[0] * inverse[1], det[1] * inverse[0]];
    let mut gradients = [[DVec2::ZERO; 3]; 2];
    let mut shapes = [0.0; 2];
    for d in 0..2 {
        // Makes the shape term 1 for an equilateral triangle: with sides of 1, its squared edges
        // add up to 3, and twice its area is √3 / 2.
        let equilateral = inverse[d] / (2.0 * 3f64.sqrt());
        shapes[d] = squares(e[d]) * equilateral;
        // Derivative of the cost with respect to twice the area of the face in this design.
        let by_det = -4.0 * squared * squared - 2.0 * shapes[d] * shapes[d]
            + area_weight * 0.5 * (ratios[d] - ratios[1 - d]);
        let by_det = by_det * inverse[d];
        let (by_dirichlet, by_squares) = (
            8.0 * squared * conformal * both,
            4.0 * shapes[d] * equilateral,
        );
        let pulls = products[1 - d].map(|product| by_dirichlet * product + by_squares);
        for k in 0..3 {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            // Moving corner k changes the two edges that meet at it. It changes the area in
            // proportion to the edge opposite the corner.
            gradients[d][k] =
                pulls[next] * e[d][next] - pulls[last] * e[d][last] + by_det * e[d][k].perp();
        }
    }
    let value = squared * squared
        + (shapes[0] * shapes[0] + shapes[1] * shapes[1])
        + area_weight * 0.5 * (ratios[0] + ratios[1]);
    // The inverse of a tiny area may be infinite; such a face counts as not positive.
    value.is_finite().then_some(FaceCost { value, gradients })
}

/// For each design, the stiffness of each edge: the second derivative of the cost with respect to
/// that edge vector, at fixed areas and with the other design fixed. Springs of this stiffness
/// precondition the minimisation of the cost. A single stiffness may be negative, but the stiffness
/// matrix of the face is positive semidefinite.
pub(super) fn stiffness(p: FaceCorners, q: FaceCorners) -> [[f64; 3]; 2] {
    let det = [p, q].map(twice_area);
    let e = [edges(p), edges(q)];
    let products = e.map(products);
    let conformal = dirichlet(products[0], e[1]) / (2.0 * det[0] * det[1]);
    [0, 1].map(|d| {
        let equilateral = 2.0 * 3f64.sqrt() * det[d];
        let shape = squares(e[d]) / equilateral;
        let of_map = 8.0 * conformal.powi(3) / (2.0 * det[0] * det[1]);
        let of_edge = |product: f64| of_map * product + 4.0 * shape / equilateral;
        products[1 - d].map(of_edge)
    })
}

/// Edge vectors of a face. Edge k lies opposite corner k; the three edges add up to zero.
fn edges(p: FaceCorners) -> FaceCorners {
    [p[2] - p[1], p[0] - p[2], p[1] - p[0]]
}

/// Sum of the squared lengths of three edges.
fn squares(e: FaceCorners) -> f64 {
    e.iter().map(|e| e.length_squared()).sum()
}

/// For each corner, the dot product of the two edge vectors that leave it. It is the cotangent of
/// the corner's angle times twice the area of the face.
fn products(e: FaceCorners) -> [f64; 3] {
    [-e[1].dot(e[2]), -e[2].dot(e[0]), -e[0].dot(e[1])]
}

/// Returns 2A · 2B · |J|² / det J, where A and B are the areas of the face in the two designs, J is
/// the Jacobian of the face's affine map from one design to the other, and |J| is its Frobenius
/// norm. Exchanging the designs gives the same number. `products` holds the products of the face's
/// edges in one design, as [`products`] returns them, and `e` holds its edges in the other design.
fn dirichlet(products: [f64; 3], e: FaceCorners) -> f64 {
    (0..3).map(|k| products[k] * e[k].length_squared()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: FaceCorners = [DVec2::ZERO, DVec2::new(1.0, 0.1), DVec2::new(0.3, 0.8)];
    const Q: FaceCorners = [
        DVec2::new(0.1, 0.0),
        DVec2::new(2.0, 0.4),
        DVec2::new(0.2, 0.5),
    ];

    fn distortion(p: FaceCorners, q: FaceCorners) -> f64 {
        dirichlet(products(edges(p)), edges(q)) / (2.0 * twice_area(p) * twice_area(q))
    }

    #[test]
    fn distortion_agrees_with_singular_values() {
        let stretched = P.map(|p| DVec2::new(3.0 * p.x, p.y));
        assert!((distortion(P, stretched) - 0.5 * (3.0 + 1.0 / 3.0)).abs() < 1e-12);
        assert!((distortion(P, Q) - distortion(Q, P)).abs() < 1e-12);
    }

    #[test]
    fn gradients_agree_with_differences() {
        let cost = evaluate(P, Q, AREA_WEIGHT).expect("positive");
        let h = 1e-6;
        for design in 0..2 {
            for corner in 0..3 {
                for axis in [DVec2::X, DVec2::Y] {
                    let moved = |by: f64| {
                        let mut corners = [P, Q];
                        corners[design][corner] += by * axis;
                        value(corners[0], corners[1])
                    };
                    let slow = (moved(h) - moved(-h)) / (2.0 * h);
                    let fast = cost.gradients[design][corner].dot(axis);
                    assert!(
                        (slow - fast).abs() < 1e-6 * (1.0 + slow.abs()),
                        "{slow} {fast}"
                    );
                }
            }
        }
    }
}
