//! Fits a similarity or an affine map from one list of points to another by least squares.

use super::{DAffine2, DMat2, DVec2};

/// Least-squares similarity that maps points to places (their target positions): a rotation and a
/// scale about the means.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SimilarityFit {
    /// Rotation and scale as a complex number: Σ p̄ q / Σ |p|² over the points p and their target
    /// positions q, both relative to their means.
    pub factor: DVec2,
    /// Mean of the points, and mean of their target positions.
    pub means: [DVec2; 2],
}

impl SimilarityFit {
    /// Fits the similarity to two lists of the same length, the points and their target positions.
    /// Returns `None` if all points or all target positions coincide, or if no rotation fits better
    /// than another.
    pub fn of(points: &[DVec2], places: &[DVec2]) -> Option<Self> {
        let count = points.len() as f64;
        let means = [points, places].map(|all| all.iter().sum::<DVec2>() / count);
        let (mut factor, mut square) = (DVec2::ZERO, 0.0);
        for (p, q) in points.iter().zip(places) {
            let (p, q) = (*p - means[0], *q - means[1]);
            factor += DVec2::new(p.dot(q), p.perp_dot(q));
            square += p.length_squared();
        }
        // The factor is 0 / 0, which is NaN, if all points coincide.
        let factor = factor / square;
        (factor.is_finite() && factor != DVec2::ZERO).then_some(Self { factor, means })
    }

    /// Applies the similarity to a point.
    pub fn apply(&self, p: DVec2) -> DVec2 {
        self.means[1] + self.factor.rotate(p - self.means[0])
    }

    /// Returns the rotation in radians, counter-clockwise.
    pub fn angle(&self) -> f64 {
        self.factor.to_angle()
    }

    /// Returns the root mean square of the distances between the mapped points and their target
    /// positions.
    pub fn residual(&self, points: &[DVec2], places: &[DVec2]) -> f64 {
        let off = |(p, q): (&DVec2, &DVec2)| self.apply(*p).distance_squared(*q);
        let sum: f64 = points.iter().zip(places).map(off).sum();
        (sum / points.len() as f64).sqrt()
    }
}

/// Points count as collinear if the determinant of their scatter matrix is at most this fraction of
/// the matrix's squared trace (tolerance: above rounding).
const COLLINEAR_RATIO: f64 = 1e-12;

/// Returns the least-squares affine map from points to their target positions, two lists of the
/// same length. Collinear points give the least-squares similarity, and a single point gives a
/// translation.
pub(crate) fn fit_affine(points: &[DVec2], places: &[DVec2]) -> DAffine2 {
    let count = points.len().max(1) as f64;
    let [from, to] = [points, places].map(|all| all.iter().sum::<DVec2>() / count);
    let (mut scatter, mut cross_scatter) = (DMat2::ZERO, DMat2::ZERO);
    for (p, q) in points.iter().zip(places) {
        let (p, q) = (*p - from, *q - to);
        scatter += DMat2::from_cols(p * p.x, p * p.y);
        cross_scatter += DMat2::from_cols(q * p.x, q * p.y);
    }
    // `size`, the trace of the scatter matrix, is the sum of the squared distances from the mean.
    // The determinant is compared with its square, so the result does not depend on scale.
    let size = scatter.x_axis.x + scatter.y_axis.y;
    let linear = if scatter.determinant() > COLLINEAR_RATIO * size * size {
        cross_scatter * scatter.inverse()
    } else {
        SimilarityFit::of(points, places).map_or(DMat2::IDENTITY, |fit| {
            DMat2::from_cols(fit.factor, fit.factor.perp())
        })
    };
    DAffine2::from_mat2_translation(linear, to - linear * from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_map_is_found_again() {
        let map = DAffine2::from_cols_array(&[2.0, 0.5, -1.0, 1.5, 30.0, -4.0]);
        let corners = [(0.0, 0.0), (4.0, 1.0), (3.0, 5.0), (-1.0, 2.0)].map(DVec2::from);
        let places = corners.map(|p| map.transform_point2(p));
        let off = |(p, q): (DVec2, DVec2)| {
            fit_affine(&corners, &places)
                .transform_point2(p)
                .distance(q)
        };
        assert!(
            corners
                .into_iter()
                .zip(places)
                .map(off)
                .all(|off| off < 1e-12)
        );
        // Collinear points determine no more than a similarity, and one point a translation.
        let line = [(0.0, 0.0), (2.0, 0.0)].map(DVec2::from);
        let turned = [(1.0, 1.0), (1.0, 5.0)].map(DVec2::from);
        let up = fit_affine(&line, &turned).transform_point2(DVec2::Y);
        assert!(up.distance(DVec2::new(-1.0, 1.0)) < 1e-12, "{up}");
        assert_eq!(
            fit_affine(&[DVec2::X], &[DVec2::Y]).transform_point2(DVec2::X),
            DVec2::Y
        );
    }
}
