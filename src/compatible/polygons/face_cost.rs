//! What one face costs in its two embeddings, with gradients.
//!
//! The cost is symmetric in the two designs: the fourth power of the conformal
//! distortion of the map between them (Hormann, Greiner 2000), the squared
//! shape of the face in each, and a little of the change of area. It grows
//! beyond all bounds as a face flattens in either design.
//!
//! By the fourth power and the shapes as they are, instead of the square and a twentieth
//! of the shapes, conformal distortion (95th percentile, median and worst tenth) of 60
//! pairs of outlines went from 3.0 and 11.4 to 2.4 and 5.9, of 200 of letters from 3.8 and
//! 8.0 to 2.7 and 5.4, of 60 of icons from 5.1 and 22 to 4.0 and 23. By the sixth power
//! the last is 33; with a twentieth of the shapes, faces are thinner by a half.

use crate::geometry::{DVec2, orient2d, twice_signed_area};

pub(super) type FaceCorners = [DVec2; 3];

/// What the change of area counts. Little, since parts do grow and shrink;
/// without it faces could trade their areas for nothing.
pub(super) const AREA_WEIGHT: f64 = 0.02;

/// A cost and its gradients by the corners in the source and in the target.
pub(super) struct FaceCost {
    pub(super) value: f64,
    pub(super) gradients: [FaceCorners; 2],
}

/// Twice the area in plain floating point.
pub(super) fn twice_area(p: FaceCorners) -> f64 {
    twice_signed_area(p[0], p[1], p[2])
}

/// Squared edges over the area, 1 for an equilateral triangle; infinite for
/// one that is not positive.
pub(super) fn shape(p: FaceCorners) -> f64 {
    let det = twice_area(p);
    if det > 0.0 {
        squares(edges(p)) / (2.0 * 3f64.sqrt() * det)
    } else {
        f64::INFINITY
    }
}

/// Whether a face is positive, exactly.
pub(super) fn is_positive(p: FaceCorners) -> bool {
    orient2d(p[0], p[1], p[2]) > 0.0
}

/// The cost alone; infinite where a face is not positive in both.
pub(super) fn value(p: FaceCorners, q: FaceCorners) -> f64 {
    evaluate(p, q, AREA_WEIGHT).map_or(f64::INFINITY, |cost| cost.value)
}

/// The cost with its gradients, at this price of the change of area; `None` where a face is not positive in both.
pub(super) fn evaluate(p: FaceCorners, q: FaceCorners, area: f64) -> Option<FaceCost> {
    let det = [p, q].map(twice_area);
    if !(det[0] > 0.0 && det[1] > 0.0) {
        return None;
    }
    let e = [edges(p), edges(q)];
    let products = e.map(products);
    let inverse = det.map(|det| 1.0 / det);
    let both = 0.5 * inverse[0] * inverse[1];
    // (σ₁/σ₂ + σ₂/σ₁) / 2 = |J|² / (2 det J), where det J = det[1] / det[0].
    let conformal = dirichlet(products[0], e[1]) * both;
    let squared = conformal * conformal;
    let ratios = [det[0] * inverse[1], det[1] * inverse[0]];
    let mut gradients = [[DVec2::ZERO; 3]; 2];
    let mut shapes = [0.0; 2];
    for d in 0..2 {
        // Sides of 1 have squares of 3 over a doubled area of √3 / 2.
        let equilateral = inverse[d] / (2.0 * 3f64.sqrt());
        shapes[d] = squares(e[d]) * equilateral;
        // By the doubled area, which both squares are divided by.
        let by_det = -4.0 * squared * squared - 2.0 * shapes[d] * shapes[d]
            + area * 0.5 * (ratios[d] - ratios[1 - d]);
        let by_det = by_det * inverse[d];
        let (by_dirichlet, by_squares) = (
            8.0 * squared * conformal * both,
            4.0 * shapes[d] * equilateral,
        );
        let pulls = products[1 - d].map(|product| by_dirichlet * product + by_squares);
        for k in 0..3 {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            // A corner pulls its two sides; the area grows with its height over
            // the third.
            gradients[d][k] =
                pulls[next] * e[d][next] - pulls[last] * e[d][last] + by_det * e[d][k].perp();
        }
    }
    let value = squared * squared
        + (shapes[0] * shapes[0] + shapes[1] * shapes[1])
        + area * 0.5 * (ratios[0] + ratios[1]);
    // An area may be so small that its inverse is not finite.
    value.is_finite().then_some(FaceCost { value, gradients })
}

/// The second derivative of the cost by each design's edges, where areas and
/// the other design are kept: a stiffness for each edge. That of one edge may
/// be negative, that of the face is not.
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

/// Edge k lies opposite corner k; the three add up to zero.
fn edges(p: FaceCorners) -> FaceCorners {
    [p[2] - p[1], p[0] - p[2], p[1] - p[0]]
}

fn squares(e: FaceCorners) -> f64 {
    e.iter().map(|e| e.length_squared()).sum()
}

/// For each corner the product of its two edges: its cotangent times the
/// doubled area.
fn products(e: FaceCorners) -> [f64; 3] {
    [-e[1].dot(e[2]), -e[2].dot(e[0]), -e[0].dot(e[1])]
}

/// |J|² / det J times both doubled areas, symmetric in the two.
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
