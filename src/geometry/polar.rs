//! Polar decomposition of 2×2 matrices in closed form, and functions of the symmetric factor
//! through its eigenvalues.

use super::{DMat2, DVec2};

/// Polar decomposition M = R(θ) S of a 2×2 matrix into a rotation R and a symmetric stretch S.
/// Callers may add whole turns to the angle θ, for a shape that turns by more than π.
///
/// For det M > 0 the stretch is positive definite and the decomposition is unique. For det M ≤ 0
/// the factors still multiply to M, but the stretch is not positive definite; callers reject such
/// matrices beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolarDecomposition {
    /// Rotation angle θ in radians, any real number.
    pub angle: f64,
    /// Symmetric factor S.
    pub stretch: DMat2,
}

impl PolarDecomposition {
    /// Decomposes M = [a b; c d] with θ = atan2(c − b, a + d) in (−π, π] and S = R(−θ) M.
    ///
    /// ```
    /// use morphospace::geometry::{DMat2, PolarDecomposition};
    /// let turn = DMat2::from_angle(0.5);
    /// assert!((PolarDecomposition::of(turn).angle - 0.5).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn of(m: DMat2) -> Self {
        let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
        // If both arguments are 0, M is a mirror times a scale, and any angle is right.
        let angle = (c - b).atan2(a + d);
        let s = DMat2::from_angle(-angle) * m;
        let off = 0.5 * (s.y_axis.x + s.x_axis.y); // equal up to rounding
        Self {
            angle,
            stretch: DMat2::from_cols(DVec2::new(s.x_axis.x, off), DVec2::new(off, s.y_axis.y)),
        }
    }

    /// Returns the product R(θ) S.
    #[must_use]
    pub fn matrix(&self) -> DMat2 {
        DMat2::from_angle(self.angle) * self.stretch
    }
}

/// Eigendecomposition of a symmetric 2×2 matrix: λ₁ u uᵀ + λ₂ v vᵀ with orthonormal u, v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetricEigen {
    /// Eigenvalues, the larger first.
    pub values: [f64; 2],
    /// Unit eigenvector of the larger eigenvalue; the other one is perpendicular.
    pub axis: DVec2,
}

impl SymmetricEigen {
    /// Decomposes `s`, of which only the symmetric part is used.
    #[must_use]
    pub fn of(s: DMat2) -> Self {
        let (a, d) = (s.x_axis.x, s.y_axis.y);
        let b = 0.5 * (s.x_axis.y + s.y_axis.x);
        let half = 0.5 * (a - d);
        let radius = half.hypot(b);
        let mean = 0.5 * (a + d);
        // The difference `mean - radius` may lose digits to cancellation. If the mean is positive,
        // dividing the determinant by the larger eigenvalue avoids that.
        let large = mean + radius;
        let small = if mean > 0.0 {
            (a * d - b * b) / large
        } else {
            mean - radius
        };
        Self {
            values: [large, small],
            // The angle of the vector (half, b) is twice that of the axis, also if b is 0.
            axis: DVec2::from_angle(0.5 * b.atan2(half)),
        }
    }

    /// Returns f(S): the matrix with the same eigenvectors, and with `f` applied to both
    /// eigenvalues.
    #[must_use]
    pub fn map(&self, f: impl Fn(f64) -> f64) -> DMat2 {
        let (l1, l2) = (f(self.values[0]), f(self.values[1]));
        let (u, v) = (self.axis, self.axis.perp());
        DMat2::from_cols(
            u * (l1 * u.x) + v * (l2 * v.x),
            u * (l1 * u.y) + v * (l2 * v.y),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the rotation by singular value decomposition, with one Jacobi rotation of MᵀM (slow
    /// oracle, independent of the closed form).
    fn rotation_by_svd(m: DMat2) -> DMat2 {
        let gram = m.transpose() * m;
        let phi = 0.5 * (2.0 * gram.y_axis.x).atan2(gram.x_axis.x - gram.y_axis.y);
        let v = DMat2::from_angle(phi);
        let mv = m * v;
        let u1 = mv.x_axis / mv.x_axis.length();
        DMat2::from_cols(u1, u1.perp()) * v.transpose() // U Vᵀ for det M > 0
    }

    proptest! {
        #[test]
        fn polar_equals_the_svd_route(
            turn in -3.1f64..3.1, phi in -3.0f64..3.0,
            s1 in 0.01f64..100.0, ratio in 0.01f64..1.0,
        ) {
            let v = DMat2::from_angle(phi);
            let stretch = v * DMat2::from_diagonal(DVec2::new(s1, s1 * ratio)) * v.transpose();
            let m = DMat2::from_angle(turn) * stretch;
            let polar = PolarDecomposition::of(m);
            let svd = rotation_by_svd(m);
            let closed = DMat2::from_angle(polar.angle);
            prop_assert!((closed - svd).abs_diff_eq(DMat2::ZERO, 1e-9));
            prop_assert!((closed * polar.stretch - m).abs_diff_eq(DMat2::ZERO, 1e-12 * s1));
            prop_assert!((polar.angle - turn).abs() < 1e-12);
        }

        #[test]
        fn eigen_map_of_identity_function_is_the_matrix(
            a in 0.01f64..10.0, d in 0.01f64..10.0, k in -0.99f64..0.99,
        ) {
            let b = k * (a * d).sqrt();
            let s = DMat2::from_cols(DVec2::new(a, b), DVec2::new(b, d));
            let eigen = SymmetricEigen::of(s);
            prop_assert!(eigen.values[1] > 0.0);
            prop_assert!((eigen.map(|x| x) - s).abs_diff_eq(DMat2::ZERO, 1e-13 * 10.0));
            let log = eigen.map(f64::ln);
            prop_assert!((SymmetricEigen::of(log).map(f64::exp) - s).abs_diff_eq(DMat2::ZERO, 1e-10));
        }
    }
}
