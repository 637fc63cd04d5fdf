//! The similarity that lays points onto others best.

use super::DVec2;

/// A rotation and scaling about one mean onto another, by least squares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fit {
    /// Rotation and scale as a complex number: Σ p̄ q / Σ |p|² about the means.
    pub factor: DVec2,
    /// The mean of the points, and of where they go.
    pub means: [DVec2; 2],
}

impl Fit {
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
