//! Homotopies: paths of 2×2 matrices from the identity to a local map M = R(θ) S.
//!
//! "The paper" below is "Design-Space Representation through Blended Transitions"; these are its
//! eqs. 3 to 5 and two more. All paths start at I and end at M. Except for
//! [`Homotopy::LinearAfterPolar`], exchanging source A and target B reverses the motion: the path
//! M_BA of the inverse map fulfils M_BA(1−t) · M = M_AB(t). The angle θ is an input and is not
//! computed from M, so that it may exceed π for a shape that turns further.
//!
//! [`Homotopy::at`] is the reference form for one matrix; the solver evaluates the same formulas
//! for several faces at once.

use crate::geometry::{DMat2, PolarDecomposition, SymmetricEigen};
use crate::settings::named;

/// Path of a face's local map, from the identity at t = 0 to its final value at t = 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Homotopy {
    /// (1−t) I + t M (paper, eq. 3): vertices move on straight lines. A face that rotates by a half
    /// turn collapses to a point halfway.
    Linear,
    /// R(tθ) ((1−t) I + t S) for M = R(θ) S (paper, eq. 4; Alexa, Cohen-Or, Levin 2000): constant
    /// speed of rotation, no reflection on [0, 1].
    #[default]
    Polar,
    /// R(tθ) exp(t log S) for M = R(θ) S (paper, eq. 5): det M(t) = (det M)^t is positive for every
    /// t, which suits extrapolation.
    Exponential,
    /// ((1−t) I + t R(θ)) ((1−t) I + t S) for M = R(θ) S: the linear path after polar
    /// decomposition. It exists only to reproduce the paper's figure 7b.
    LinearAfterPolar,
    /// R(tθ) √((1−t) I + t S²) for M = R(θ) S on [0, 1], and the exponential path outside. Squared
    /// lengths change linearly, so on [0, 1] no angle of the source is distorted more than at
    /// t = 1. The ARAP warp computes these local maps for all edge-connected faces together, by
    /// flattening the metrics (1−t) I + t S² (Chen, Weber, Keren, Ben-Chen 2013).
    Bounded,
}

named! { Homotopy {
    Linear: "linear", "Linear",
        "Points move on straight lines. Fast, but parts shrink while they rotate and collapse on \
         half turns.";
    LinearAfterPolar: "linear-after-polar", "Linear after polar",
        "Rotation and stretch separately, the rotation on a straight line. For comparison: shows \
         why rotation must follow a circle.";
    Polar: "polar", "Polar",
        "Parts rotate at constant speed while they stretch evenly. Suits most designs.";
    Exponential: "exponential", "Exponential",
        "Rotates at constant speed and stretches by equal factors. Never turns inside out, even \
         far beyond the designs.";
    Bounded: "bounded", "Bounded",
        "Nothing is sheared more in between than in the worse of the two designs. Sizes may \
         change and straight sides bend. Slow, unless played from a recording.";
} }

impl Homotopy {
    /// Returns whether no face can turn over for t in [0, 1].
    #[must_use]
    pub const fn keeps_orientation(self) -> bool {
        matches!(self, Self::Polar | Self::Exponential | Self::Bounded)
    }

    /// Returns the matrix at t of the path from the identity to `map`.
    ///
    /// ```
    /// use morphospace::{geometry::{DMat2, PolarDecomposition}, warp::homotopy::Homotopy};
    /// let angle = std::f64::consts::PI;
    /// let half_turn = PolarDecomposition { angle, stretch: DMat2::IDENTITY };
    /// assert!(Homotopy::Linear.at(&half_turn, 0.5).determinant().abs() < 1e-15);
    /// assert!((Homotopy::Polar.at(&half_turn, 0.5).determinant() - 1.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(self, map: &PolarDecomposition, t: f64) -> DMat2 {
        let from_identity = |m: DMat2| DMat2::IDENTITY * (1.0 - t) + m * t;
        let turned = DMat2::from_angle(t * map.angle);
        match self {
            Self::Linear => from_identity(map.matrix()),
            Self::Polar => turned * from_identity(map.stretch),
            Self::Exponential => {
                // Computes exp(t log S). The eigenvalues λ of the stretch S are positive, because
                // faces are positively oriented in both designs.
                turned * SymmetricEigen::of(map.stretch).map(|lambda| lambda.powf(t))
            }
            Self::LinearAfterPolar => {
                from_identity(DMat2::from_angle(map.angle)) * from_identity(map.stretch)
            }
            Self::Bounded => {
                if !(0.0..=1.0).contains(&t) {
                    // Squared lengths may become negative outside [0, 1].
                    return Self::Exponential.at(map, t);
                }
                let stretched = |lambda: f64| ((1.0 - t) + t * lambda * lambda).sqrt();
                turned * SymmetricEigen::of(map.stretch).map(stretched)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;
    use proptest::prelude::*;

    /// Generates local maps, including angles beyond half a turn.
    fn any_map() -> impl Strategy<Value = PolarDecomposition> {
        (-10.0f64..10.0, -2.0f64..2.0, 0.1f64..5.0, 0.1f64..5.0).prop_map(|(angle, phi, a, b)| {
            let v = DMat2::from_angle(phi);
            let stretch = v * DMat2::from_diagonal(DVec2::new(a, b)) * v.transpose();
            PolarDecomposition { angle, stretch }
        })
    }

    /// Returns the inverse of the map M = R(θ) S, decomposed into the rotation by −θ and a stretch:
    /// M⁻¹ = S⁻¹ R(−θ) = R(−θ) (R(θ) S⁻¹ R(−θ)).
    fn inverse(map: &PolarDecomposition) -> PolarDecomposition {
        let turn = DMat2::from_angle(map.angle);
        PolarDecomposition {
            angle: -map.angle,
            stretch: turn * map.stretch.inverse() * turn.transpose(),
        }
    }

    proptest! {
        #[test]
        fn the_bounded_path_is_never_sheared_more_than_its_end(
            map in any_map(),
            t in 0.0f64..1.0,
        ) {
            let sheared = |m: DMat2| {
                let [a, b] = SymmetricEigen::of(PolarDecomposition::of(m).stretch).values;
                a / b
            };
            let now = sheared(Homotopy::Bounded.at(&map, t));
            prop_assert!(now <= sheared(map.matrix()) * (1.0 + 1e-12));
        }

        #[test]
        fn every_path_joins_identity_and_map(map in any_map()) {
            for homotopy in Homotopy::ALL {
                prop_assert!(homotopy.at(&map, 0.0).abs_diff_eq(DMat2::IDENTITY, 1e-12));
                prop_assert!(homotopy.at(&map, 1.0).abs_diff_eq(map.matrix(), 1e-12));
            }
        }

        #[test]
        fn the_inverse_map_takes_the_reversed_path(map in any_map(), t in -0.5f64..1.5) {
            for homotopy in Homotopy::ALL {
                if homotopy == Homotopy::LinearAfterPolar {
                    continue;
                }
                let back = homotopy.at(&inverse(&map), 1.0 - t) * map.matrix();
                prop_assert!(back.abs_diff_eq(homotopy.at(&map, t), 1e-10), "{homotopy:?}");
            }
        }

        #[test]
        fn exponential_never_reflects(map in any_map(), t in -3.0f64..4.0) {
            let det = Homotopy::Exponential.at(&map, t).determinant();
            let expected = map.stretch.determinant().powf(t);
            prop_assert!((det / expected - 1.0).abs() < 1e-9);
        }

        #[test]
        fn angles_are_linear_in_time(map in any_map(), t in 0.0f64..1.0) {
            for homotopy in [Homotopy::Polar, Homotopy::Exponential, Homotopy::Bounded] {
                let difference = PolarDecomposition::of(homotopy.at(&map, t)).angle - t * map.angle;
                let turns = difference / std::f64::consts::TAU;
                prop_assert!((turns - turns.round()).abs() < 1e-10);
            }
        }
    }
}
