//! How much each face is distorted, by the singular values σ₁ ≥ σ₂ of its
//! Jacobian.
//!
//! Guaranteed: whether a face is folded is decided by exact predicates. Not
//! guaranteed: digits of the values of faces that are nearly flat.

use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, orient2d};
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
    /// The least determinant of a face: its signed area by that in the source.
    pub min_det: f64,
    /// The greatest one.
    pub max_det: f64,
    /// σ₁/σ₂: of angles.
    pub conformal: Distribution,
    /// max(σ₁, 1/σ₂): of lengths.
    pub isometric: Distribution,
    /// max(det, 1/det): of areas.
    pub area: Distribution,
}

/// Measures the map from the source to `places`; `None` where there are no
/// faces. Folded faces count as infinitely distorted.
///
/// # Panics
/// If there are fewer places than the mesh has vertices.
///
/// ```
/// use morphospace::{compatible::CompatibleMesh, geometry::DVec2, measure::distortion};
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let wide = vec![DVec2::ZERO, 2.0 * DVec2::X, DVec2::Y];
/// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], source, wide.clone(), vec![])?;
/// let found = distortion(&mesh, &wide).expect("there is a face");
/// assert_eq!((found.folds, found.min_det, found.conformal.worst), (0, 2.0, 2.0));
/// # Ok::<(), morphospace::compatible::CompatibleError>(())
/// ```
#[must_use]
pub fn distortion(mesh: &CompatibleMesh, places: &[DVec2]) -> Option<Distortion> {
    let faces: Vec<(FaceStrain, f64)> = mesh
        .faces()
        .iter()
        .map(|face| {
            let rest = edges(mesh.source(), face);
            let strain = FaceStrain {
                folded: is_folded(places, face),
                ..FaceStrain::of(edges(places, face) * rest.inverse())
            };
            (strain, rest.determinant())
        })
        .collect();
    let over = |measure: fn(&FaceStrain) -> f64| {
        distribution(faces.iter().map(|(s, area)| (measure(s), *area)).collect())
    };
    let dets = faces.iter().map(|(strain, _)| strain.det);
    Some(Distortion {
        folds: faces.iter().filter(|(s, _)| s.folded).count(),
        min_det: dets.clone().fold(f64::INFINITY, f64::min),
        max_det: dets.fold(f64::NEG_INFINITY, f64::max),
        conformal: over(FaceStrain::conformal)?,
        isometric: over(FaceStrain::isometric)?,
        area: over(FaceStrain::area)?,
    })
}

/// Two edges of a face as a matrix.
pub(super) fn edges(points: &[DVec2], face: &[u32; 3]) -> DMat2 {
    let [a, b, c] = face.map(|v| points[v as usize]);
    DMat2::from_cols(b - a, c - a)
}

/// Whether a face is turned over or flat (det ≤ 0), exactly.
pub(super) fn is_folded(places: &[DVec2], face: &[u32; 3]) -> bool {
    let [a, b, c] = face.map(|v| places[v as usize]);
    // NaN counts as folded.
    let exact = orient2d(a, b, c);
    exact.is_nan() || exact <= 0.0
}

/// What a Jacobian does to lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceStrain {
    large: f64,
    small: f64,
    pub(super) det: f64,
    folded: bool,
}

impl FaceStrain {
    pub(super) fn of(m: DMat2) -> Self {
        let (large, small) = singular_values(m);
        let det = m.determinant();
        Self {
            large,
            small,
            det,
            folded: small.is_nan() || small <= 0.0,
        }
    }

    fn whole(&self, value: f64) -> f64 {
        // 0 / 0 of a face that collapsed is as bad as a fold.
        if self.folded || value.is_nan() {
            f64::INFINITY
        } else {
            value
        }
    }

    pub(super) fn conformal(&self) -> f64 {
        self.whole(self.large / self.small.abs())
    }

    pub(super) fn isometric(&self) -> f64 {
        self.whole(self.large.max(1.0 / self.small.abs()))
    }

    pub(super) fn area(&self) -> f64 {
        self.whole(self.det.max(1.0 / self.det).abs())
    }
}

/// σ₁ ≥ |σ₂|, the second with the sign of the determinant.
fn singular_values(m: DMat2) -> (f64, f64) {
    // Blinn (1996): the matrix as a rotation-like and a reflection-like half.
    let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
    let turning = 0.5 * (a + d).hypot(c - b);
    let flipping = 0.5 * (a - d).hypot(c + b);
    (turning + flipping, turning - flipping)
}

/// Quantiles of values with weights; `None` for no values.
pub(super) fn distribution(mut values: Vec<(f64, f64)>) -> Option<Distribution> {
    values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
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
    fn a_shear_by_hand() {
        // [1 s; 0 1] has σ₁ − 1/σ₁ = s and det 1.
        let s = 1.5;
        let strain = FaceStrain::of(DMat2::from_cols(DVec2::X, DVec2::new(s, 1.0)));
        let large = 0.5 * (s + f64::hypot(s, 2.0));
        assert!((strain.conformal() - large * large).abs() < 1e-12);
        assert!((strain.isometric() - large).abs() < 1e-12);
        assert!((strain.area() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nearly_flat_faces_are_told_apart_exactly() {
        let sliver = |y: f64| [DVec2::ZERO, DVec2::X, DVec2::new(0.5, y)];
        assert!(!is_folded(&sliver(1e-300), &[0, 1, 2]));
        assert!(is_folded(&sliver(0.0), &[0, 1, 2]));
        assert!(is_folded(&sliver(-1e-300), &[0, 1, 2]));
        assert!(is_folded(&sliver(f64::NAN), &[0, 1, 2]));
    }

    #[test]
    fn quantiles_weigh_by_area() {
        let d = distribution(vec![(9.0, 1.0), (1.0, 90.0), (2.0, 9.0)]).expect("values");
        assert_eq!((d.median, d.p95, d.worst), (1.0, 2.0, 9.0));
        assert_eq!(distribution(Vec::new()), None);
    }
}
