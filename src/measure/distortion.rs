//! Distortion of each face, computed from the singular values σ₁ ≥ σ₂ of a Jacobian: that of the
//! linear map that takes the face from the source to its current position.
//!
//! Exact predicates decide whether a face is folded. The distortion of nearly flat faces is
//! affected by rounding.

use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, orient2d};
use serde::Serialize;

/// Weighted distribution of a measure: over faces, weighted by their area in the source, or over
/// the boundary, weighted by its length in the source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distribution {
    /// Value that half of the total weight does not exceed.
    pub median: f64,
    /// Value that 95 % of the total weight does not exceed.
    pub p95: f64,
    /// Largest value.
    pub worst: f64,
}

/// Distortion of the faces when the vertices move from the source to other positions. For an
/// undistorted mesh, all values except `folds` are 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distortion {
    /// Number of faces that are folded or flat (signed area ≤ 0).
    pub folds: usize,
    /// Smallest determinant of any face. The determinant of a face is its signed area divided by
    /// its area in the source.
    pub min_det: f64,
    /// Largest determinant of any face.
    pub max_det: f64,
    /// Distortion of angles over the faces: σ₁/σ₂, the ratio of the singular values of a face's
    /// Jacobian.
    pub conformal: Distribution,
    /// Distortion of lengths over the faces: max(σ₁, 1/σ₂), where σ₁ ≥ σ₂ are the singular values
    /// of a face's Jacobian.
    pub isometric: Distribution,
    /// Distortion of areas over the faces: max(det, 1/det), where det is the determinant of a
    /// face's Jacobian.
    pub area: Distribution,
}

/// Measures how the faces are distorted when the vertices move from the source to `places`. Returns
/// `None` if there are no faces.
///
/// The distortion of folded faces is infinite.
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
            let in_source = edges(mesh.source(), face);
            let strain = FaceStrain {
                folded: is_folded(places, face),
                ..FaceStrain::of(edges(places, face) * in_source.inverse())
            };
            (strain, in_source.determinant())
        })
        .collect();
    let distribution_of = |measure: fn(&FaceStrain) -> f64| {
        distribution(faces.iter().map(|(s, area)| (measure(s), *area)).collect())
    };
    let dets = faces.iter().map(|(strain, _)| strain.det);
    Some(Distortion {
        folds: faces.iter().filter(|(s, _)| s.folded).count(),
        min_det: dets.clone().fold(f64::INFINITY, f64::min),
        max_det: dets.fold(f64::NEG_INFINITY, f64::max),
        conformal: distribution_of(FaceStrain::conformal)?,
        isometric: distribution_of(FaceStrain::isometric)?,
        area: distribution_of(FaceStrain::area)?,
    })
}

/// Returns the matrix whose columns are two edge vectors of a face.
pub(super) fn edges(points: &[DVec2], face: &[u32; 3]) -> DMat2 {
    let [a, b, c] = face.map(|v| points[v as usize]);
    DMat2::from_cols(b - a, c - a)
}

/// Returns whether a face is folded or flat (det ≤ 0), by an exact predicate.
pub(super) fn is_folded(places: &[DVec2], face: &[u32; 3]) -> bool {
    let [a, b, c] = face.map(|v| places[v as usize]);
    let orientation = orient2d(a, b, c);
    // NaN coordinates count as folded.
    orientation.is_nan() || orientation <= 0.0
}

/// Singular values and determinant of a face's Jacobian.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceStrain {
    /// Larger singular value σ₁.
    large: f64,
    /// Smaller singular value σ₂, with the sign of the determinant.
    small: f64,
    /// Determinant σ₁σ₂.
    pub(super) det: f64,
    folded: bool,
}

impl FaceStrain {
    /// Decomposes a Jacobian. Unlike in [`is_folded`], rounding decides whether a nearly flat face
    /// counts as folded.
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

    /// Returns `value`, or infinity if the face is folded or `value` is NaN. `value` is NaN (0/0)
    /// for a face that has collapsed to a point.
    fn or_infinite(&self, value: f64) -> f64 {
        if self.folded || value.is_nan() {
            f64::INFINITY
        } else {
            value
        }
    }

    /// Returns σ₁/σ₂; infinite if folded.
    pub(super) fn conformal(&self) -> f64 {
        self.or_infinite(self.large / self.small.abs())
    }

    /// Returns max(σ₁, 1/σ₂); infinite if folded.
    pub(super) fn isometric(&self) -> f64 {
        self.or_infinite(self.large.max(1.0 / self.small.abs()))
    }

    /// Returns max(det, 1/det); infinite if folded.
    pub(super) fn area(&self) -> f64 {
        self.or_infinite(self.det.max(1.0 / self.det).abs())
    }
}

/// Returns the singular values σ₁ ≥ |σ₂| of a matrix; σ₂ has the sign of the determinant.
///
/// Follows Blinn (1996): splits the matrix into a scaled rotation and a scaled reflection.
fn singular_values(m: DMat2) -> (f64, f64) {
    let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
    let rotation = 0.5 * (a + d).hypot(c - b);
    let reflection = 0.5 * (a - d).hypot(c + b);
    (rotation + reflection, rotation - reflection)
}

/// Returns the median, the 95th percentile and the maximum of `(value, weight)` pairs; `None`
/// without values.
pub(super) fn distribution(mut values: Vec<(f64, f64)>) -> Option<Distribution> {
    values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    let worst = values.last()?.0;
    let quantile = |fraction: f64| {
        let mut sum = 0.0;
        let first_reaching = values.iter().find(|(_, weight)| {
            sum += weight;
            sum >= fraction * total
        });
        first_reaching.map_or(worst, |(value, _)| *value)
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
    fn a_shear_matches_the_closed_form() {
        // The shear matrix [1 s; 0 1] has σ₁ − 1/σ₁ = s and determinant 1.
        let s = 1.5;
        let strain = FaceStrain::of(DMat2::from_cols(DVec2::X, DVec2::new(s, 1.0)));
        let large = 0.5 * (s + f64::hypot(s, 2.0));
        assert!((strain.conformal() - large * large).abs() < 1e-12);
        assert!((strain.isometric() - large).abs() < 1e-12);
        assert!((strain.area() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nearly_flat_faces_are_classified_exactly() {
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
