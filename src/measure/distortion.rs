//! How much each face is distorted, by the singular values σ₁ ≥ σ₂ of its
//! Jacobian.

use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, twice_signed_area};
use serde::Serialize;

/// A measure over faces, weighted by area in the source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distribution {
    /// Half of the area is at or below this.
    pub median: f64,
    /// Of the area, 95 % is at or below this.
    pub p95: f64,
    /// The worst face.
    pub worst: f64,
}

/// Distortion of the faces between the source and a placement of its
/// vertices. 1 is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distortion {
    /// Faces that are turned over or flat (det ≤ 0).
    pub folds: usize,
    /// σ₁/σ₂: of angles.
    pub conformal: Distribution,
    /// max(σ₁, 1/σ₂): of lengths.
    pub isometric: Distribution,
    /// max(det, 1/det): of areas.
    pub area: Distribution,
}

/// Measures the map from the source to `places`; `None` where there are no
/// faces. Folded faces count as infinitely distorted.
#[must_use]
pub fn distortion(mesh: &CompatibleMesh, places: &[DVec2]) -> Option<Distortion> {
    let maps: Vec<(DMat2, f64)> = mesh
        .faces()
        .iter()
        .map(|face| {
            let edges = |points: &[DVec2]| {
                let [a, b, c] = face.map(|v| points[v as usize]);
                (
                    DMat2::from_cols(b - a, c - a),
                    0.5 * twice_signed_area(a, b, c),
                )
            };
            let (source, area) = edges(mesh.source());
            (edges(places).0 * source.inverse(), area)
        })
        .collect();
    let over = |measure: fn(f64, f64) -> f64| {
        let weighted = maps.iter().map(|&(m, area)| {
            let (large, small) = singular_values(m);
            (
                if small > 0.0 {
                    measure(large, small)
                } else {
                    f64::INFINITY
                },
                area,
            )
        });
        distribution(weighted.collect())
    };
    Some(Distortion {
        folds: maps.iter().filter(|(m, _)| m.determinant() <= 0.0).count(),
        conformal: over(|large, small| large / small)?,
        isometric: over(|large, small| large.max(1.0 / small))?,
        area: over(|large, small| (large * small).max(1.0 / (large * small)))?,
    })
}

/// σ₁ ≥ |σ₂|, the second with the sign of the determinant.
pub(super) fn singular_values(m: DMat2) -> (f64, f64) {
    // Blinn (1996): the matrix as a rotation-like and a reflection-like half.
    let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
    let turning = 0.5 * (a + d).hypot(c - b);
    let flipping = 0.5 * (a - d).hypot(c + b);
    (turning + flipping, turning - flipping)
}

/// Quantiles of values with weights; `None` for no values.
fn distribution(mut values: Vec<(f64, f64)>) -> Option<Distribution> {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    let worst = values.last()?.0;
    let quantile = |share: f64| {
        let mut sum = 0.0;
        let reached = values.iter().find(|(_, weight)| {
            sum += weight;
            sum >= share * total
        });
        reached.map_or(worst, |(value, _)| *value)
    };
    Some(Distribution {
        median: quantile(0.5),
        p95: quantile(0.95),
        worst,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_of_known_matrices() {
        let turned = DMat2::from_angle(1.0) * DMat2::from_diagonal(DVec2::new(3.0, 0.5));
        let (large, small) = singular_values(turned);
        assert!((large - 3.0).abs() < 1e-12 && (small - 0.5).abs() < 1e-12);
        let (_, flipped) = singular_values(DMat2::from_diagonal(DVec2::new(1.0, -2.0)));
        assert!((flipped + 1.0).abs() < 1e-12);
    }

    #[test]
    fn quantiles_weigh_by_area() {
        let d = distribution(vec![(9.0, 1.0), (1.0, 90.0), (2.0, 9.0)]).expect("values");
        assert_eq!((d.median, d.p95, d.worst), (1.0, 2.0, 9.0));
        assert_eq!(distribution(Vec::new()), None);
    }
}
