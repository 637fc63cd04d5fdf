//! Features that meet on their way: they cannot be told apart where they are
//! one, and just before they would tear the plane.
//!
//! Two features at distance d whose looks differ by D make the plane D / d
//! times as steep between them. Up to a limit K nothing is changed. Beyond it
//! their difference is shrunk by (K d / D)², so that the slope returns to zero
//! instead of growing without bound. What the two say of the slope between
//! them also has to be heard less and less, or it would be lost with a jump
//! when they are one: that is done by the system, for the pairs that are
//! returned.

use crate::geometry::DVec2;

/// How many times steeper than the frame a look-up may be between two
/// features before they give way. At 20, two features a hundredth of the
/// frame apart may be a fifth of it apart in a design, and both are met.
pub(super) const STEEPEST: f64 = 20.0;

/// Two features that are too near for what they want.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooNear {
    pub(super) pair: [usize; 2],
    /// (K d / D)², below 1.
    pub(super) shrunk: f64,
    /// μ of the system; 0 until it is known.
    pub(super) tie: f64,
}

/// Shrinks differences steeper than `steepest`, and says whose. `memory` has
/// no meaning.
pub(super) fn ease<const K: usize>(
    at: &[DVec2],
    looks: &mut [[DVec2; K]],
    steepest: f64,
    too_near: &mut Vec<TooNear>,
    memory: &mut Vec<[DVec2; K]>,
) {
    too_near.clear();
    memory.clear();
    memory.extend_from_slice(looks);
    for (i, look) in looks.iter_mut().enumerate() {
        let (mut sums, mut weights) = (memory[i], [1.0; K]);
        for (j, &other) in at.iter().enumerate() {
            let allowed = steepest * steepest * at[i].distance_squared(other);
            let mut least = 1.0_f64;
            for k in 0..K {
                let difference = memory[i][k].distance_squared(memory[j][k]);
                if allowed < difference {
                    let shrunk = allowed / difference;
                    // With w at both, a difference shrinks by (1 − w) / (1 + w).
                    let weight = (1.0 - shrunk) / (1.0 + shrunk);
                    sums[k] += weight * memory[j][k];
                    weights[k] += weight;
                    least = least.min(shrunk);
                }
            }
            if least < 1.0 && i < j {
                too_near.push(TooNear {
                    pair: [i, j],
                    shrunk: least,
                    tie: 0.0,
                });
            }
        }
        for ((look, sum), weight) in look.iter_mut().zip(sums).zip(weights) {
            *look = sum / weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_rise_and_fall_without_a_jump() {
        let eased = |d: f64| {
            let at = [DVec2::ZERO, DVec2::X * d];
            let mut looks = [DVec2::Y, -DVec2::Y].map(|v| [v, DVec2::X]);
            let mut pairs = Vec::new();
            ease(&at, &mut looks, STEEPEST, &mut pairs, &mut Vec::new());
            assert_eq!(looks[0][1], DVec2::X);
            assert_eq!(looks[0][0] + looks[1][0], DVec2::ZERO);
            assert_eq!(pairs.len(), usize::from(looks[0][0] != DVec2::Y));
            looks[0][0].y
        };
        let edge = 2.0 / STEEPEST;
        assert_eq!(eased(edge * 1.001), 1.0);
        assert!((eased(edge * 0.999) - 0.998).abs() < 1e-5);
        assert!((eased(edge / 2.0) - 0.25).abs() < 1e-12);
        assert_eq!(eased(0.0), 0.0);
    }
}
