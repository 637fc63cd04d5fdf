//! A blend that stays folded is shown as the nearest one that is not, on the way to the design
//! with the most weight: there no face is folded, as a family has none that are.
//!
//! Guaranteed: where it ends nothing is folded. Not guaranteed: that it goes smoothly with the
//! weights, and which of two designs with as much weight it goes to where both are as near.

use super::BlendPlacer;

/// Halvings of the way to a design: to a thousandth of it.
const HALVINGS: usize = 10;

/// Weights of two designs that differ by no more than this are one.
const TIED: f64 = 1e-9;

impl BlendPlacer {
    /// Goes from a folded blend towards the design with the most weight, which has no fold,
    /// just so far that there is none; of several such designs the shortest way.
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

    /// Places the blend that lies so far on the way to a design, and says whether none of its
    /// faces is folded.
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
