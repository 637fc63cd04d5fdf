//! The similarity and the affine map that lay points onto others best.

use super::{DAffine2, DMat2, DVec2};

/// A rotation and scaling about one mean onto another, by least squares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SimilarityFit {
    /// Rotation and scale as a complex number: Σ p̄ q / Σ |p|² about the means.
    pub factor: DVec2,
    /// The mean of the points, and of where they go.
    pub means: [DVec2; 2],
}

impl SimilarityFit {
    /// Of as many points as places; none where either are all one.
    pub fn of(points: &[DVec2], places: &[DVec2]) -> Option<Self> {
        let count = points.len() as f64;
        let means = [points, places].map(|all| all.iter().sum::<DVec2>() / count);
        let (mut factor, mut square) = (DVec2::ZERO, 0.0);
        for (p, q) in points.iter().zip(places) {
            let (p, q) = (*p - means[0], *q - means[1]);
            factor += DVec2::new(p.dot(q), p.perp_dot(q));
            square += p.length_squared();
        }
        // 0 / 0 where the points are one.
        let factor = factor / square;
        (factor.is_finite() && factor != DVec2::ZERO).then_some(Self { factor, means })
    }

    pub fn apply(&self, p: DVec2) -> DVec2 {
        self.means[1] + self.factor.rotate(p - self.means[0])
    }

    /// The rotation in radians, counter-clockwise.
    pub fn angle(&self) -> f64 {
        self.factor.to_angle()
    }

    /// How far off the points are, as a root of the mean square.
    pub fn residual(&self, points: &[DVec2], places: &[DVec2]) -> f64 {
        let off = |(p, q): (&DVec2, &DVec2)| self.apply(*p).distance_squared(*q);
        let sum: f64 = points.iter().zip(places).map(off).sum();
        (sum / points.len() as f64).sqrt()
    }
}

/// A plane's points on a line are not told from an area below this share.
const FLAT: f64 = 1e-12;

/// The affine map by least squares of as many points as places; of points on a line a
/// similarity, of one point an offset.
pub(crate) fn fit_affine(points: &[DVec2], places: &[DVec2]) -> DAffine2 {
    let count = points.len().max(1) as f64;
    let [from, to] = [points, places].map(|all| all.iter().sum::<DVec2>() / count);
    let (mut own, mut across) = (DMat2::ZERO, DMat2::ZERO);
    for (p, q) in points.iter().zip(places) {
        let (p, q) = (*p - from, *q - to);
        own += DMat2::from_cols(p * p.x, p * p.y);
        across += DMat2::from_cols(q * p.x, q * p.y);
    }
    let size = own.x_axis.x + own.y_axis.y;
    let linear = if own.determinant() > FLAT * size * size {
        across * own.inverse()
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
        // On a line, where a similarity is the most that can be known; and one point.
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
