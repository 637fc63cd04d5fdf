//! Replaces a blend that stays folded by the nearest blend without folds between it and the design
//! with the largest weight.
//!
//! Guaranteed: the result has no folded face, because the designs have none. Not guaranteed: that
//! the result depends continuously on the weights; if two designs with equal weight are equally
//! near, the first one is chosen.

use super::BlendPlacer;

/// Number of bisections of the way to a design (derived: accurate to 2⁻¹⁰, about a thousandth of
/// the way).
const HALVINGS: usize = 10;

/// Weights that differ by at most this count as equal (tolerance: above rounding).
const TIED: f64 = 1e-9;

impl BlendPlacer {
    /// Moves a folded blend towards the design with the largest weight, just far enough that no
    /// face is folded. If several designs have the largest weight, the nearest result is chosen.
    pub(super) fn retreat(&mut self, weights: &[f64]) {
        let most = weights.iter().copied().fold(0.0, f64::max);
        let (mut shortest, mut to) = (f64::INFINITY, 0);
        for design in 0..weights.len() {
            if weights[design] < most - TIED {
                continue;
            }
            let (mut folded, mut free) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let way = 0.5 * (folded + free);
                if self.solve_towards(weights, design, way) {
                    free = way;
                } else {
                    folded = way;
                }
            }
            if free < shortest {
                (shortest, to) = (free, design);
            }
        }
        self.solve_towards(weights, to, shortest);
    }

    /// Places the blend at the fraction `way` of the way to a design. Returns whether no face is
    /// folded.
    fn solve_towards(&mut self, weights: &[f64], design: usize, way: f64) -> bool {
        let mut towards = std::mem::take(&mut self.towards);
        for (own, weight) in towards.iter_mut().zip(weights) {
            *own = (1.0 - way) * weight;
        }
        towards[design] += way;
        let is_free = self.solve(&towards);
        self.towards = towards;
        is_free
    }
}
