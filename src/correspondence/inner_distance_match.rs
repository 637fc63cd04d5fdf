//! The match of two boundaries by what is seen of the inside.
//!
//! Two samples are unlike by how much farther, or nearer, they are within
//! their shapes from samples that belong together. Which those are is not
//! known at first: the first path compares each sample's row of inner
//! distances to what lies ahead along the boundary (Ling, Jacobs 2007). Each
//! path found then says where to look across, and the next is found with
//! that: the Gromov–Wasserstein comparison of two metrics (Mémoli 2011)
//! by alternating, with the cyclic dynamic program in the place of transport.
//!
//! Guaranteed: deterministic. Not guaranteed: the best of all paths;
//! alternating ends where nothing more is gained, or after some rounds.

use super::curve_problem::CurveMatchProblem;
use super::inner_descriptors::{AHEAD, inner_dissimilarities};
use super::poses::PathSolution;

/// Pairs that samples are compared at are at least so far apart, as the sum of
/// both shares of length: some 160 around. No measure fixed it.
const STRIDE: f64 = 0.012;

/// How often the pairs of a path are looked across from, if each time gains.
/// No measure fixed it.
const ROUNDS: usize = 6;

impl CurveMatchProblem {
    /// The best path by inner distances; none where they are not asked for, or
    /// where a curve has no inside.
    pub(super) fn solution_inside(&self) -> Option<PathSolution> {
        let Some(coarse) = &self.coarse else {
            return self.settled_inside();
        };
        // So few samples tell what belongs together, all of them where exactly.
        let found = coarse.settled_inside()?;
        self.seen_from(&coarse.carried(&found.nodes, self))
    }

    /// The path from which the inner distances lead to no better one.
    fn settled_inside(&self) -> Option<PathSolution> {
        let [a, b] = self.inner.as_ref()?;
        let rows = [a.ahead(&self.source), b.ahead(&self.target)];
        let ahead = inner_dissimilarities(&rows[0], &rows[1], &[1.0; AHEAD as usize]);
        let first = self.path_inside(&ahead);
        let mut best = self.seen_from(&first.nodes)?;
        for _ in 1..ROUNDS {
            let next = self.seen_from(&best.nodes)?;
            if next.cost >= best.cost {
                break;
            }
            best = next;
        }
        Some(best)
    }

    /// The best path by the distances to the pairs of another.
    fn seen_from(&self, nodes: &[[usize; 2]]) -> Option<PathSolution> {
        let [a, b] = self.inner.as_ref()?;
        let (pairs, weights) = self.spaced(nodes);
        let rows = [
            a.to(pairs.iter().map(|pair| pair[0])),
            b.to(pairs.iter().map(|pair| pair[1])),
        ];
        Some(self.path_inside(&inner_dissimilarities(&rows[0], &rows[1], &weights)))
    }

    fn path_inside(&self, seen: &[f64]) -> PathSolution {
        let priced = self.unposed().into_iter().zip(seen);
        self.best_path(
            priced
                .map(|(own, seen)| own + self.price_inside * seen)
                .collect(),
        )
    }

    /// Pairs of a closed path a stride apart, and the length that each stands
    /// for.
    fn spaced(&self, nodes: &[[usize; 2]]) -> (Vec<[usize; 2]>, Vec<f64>) {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let at = |[i, j]: [usize; 2]| self.source.unrolled(i) + self.target.unrolled(j);
        let (mut pairs, mut weights) = (Vec::new(), Vec::new());
        let mut last = at(nodes[0]);
        for &node in &nodes[1..] {
            let walked = at(node) - last;
            if walked >= STRIDE {
                pairs.push([node[0] % n, node[1] % m]);
                weights.push(walked);
                last = at(node);
            }
        }
        (pairs, weights)
    }

    /// A path as one through other samples of the same curves.
    fn carried(&self, nodes: &[[usize; 2]], to: &Self) -> Vec<[usize; 2]> {
        let carried = |&[i, j]: &[usize; 2]| {
            [
                to.source.nearest(self.source.unrolled(i)),
                to.target.nearest(self.target.unrolled(j)),
            ]
        };
        nodes.iter().map(carried).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::boundary::match_curves;
    use super::super::boundary_match::interpolated;
    use super::super::curve::BoundaryCurve;
    use super::super::options::MatchOptions;
    use crate::geometry::{DVec2, Ring};

    /// How many points draw each side of a limb.
    const SIDE: usize = 61;

    /// A limb that grows thinner, with what its middle line turns by at each
    /// step. Point k of one limb is point k of each.
    fn limb(turn: impl Fn(f64) -> f64) -> BoundaryCurve {
        let (mut at, mut direction) = (DVec2::ZERO, DVec2::X);
        let (mut right, mut left) = (Vec::new(), Vec::new());
        for k in 0..SIDE {
            let t = k as f64 / (SIDE - 1) as f64;
            let across = (1.8 - 0.9 * t) * direction.perp();
            right.push(at - across);
            left.push(at + across);
            direction = DVec2::from_angle(turn(t)).rotate(direction);
            at += direction;
        }
        right.extend(left.into_iter().rev());
        BoundaryCurve::closed(&Ring::new(right).expect("a ring")).expect("a size")
    }

    fn inside() -> MatchOptions {
        MatchOptions {
            inner: 8.0,
            ..MatchOptions::default()
        }
    }

    /// The farthest that a point is matched from its own, in lengths.
    fn off(source: &BoundaryCurve, target: &BoundaryCurve, options: &MatchOptions) -> f64 {
        let found = match_curves(source, target, &[], options).expect("a match");
        let mut knots = found.knots().to_vec();
        for k in 1..knots.len() {
            if knots[k][1] < knots[0][1] {
                knots[k][1] += 1.0;
            }
        }
        knots.push(knots[0].map(|place| place + 1.0));
        let mut worst: f64 = 0.0;
        for (a, b) in source.places().iter().zip(target.places()) {
            let over = f64::from(u8::from(*a < knots[0][0]));
            let by = interpolated(&knots, a + over, [0, 1]) - b;
            worst = worst.max((by - by.round()).abs());
        }
        worst
    }

    #[test]
    fn a_limb_is_found_again_however_it_is_bent() {
        let straight = limb(|_| 0.0);
        let bent = limb(|t| if t < 0.5 { 0.09 } else { -0.09 });
        let curled = limb(|t| 0.16 - 0.1 * t);
        let spring = limb(|t| 0.33 * (25.0 * t).sin());
        let limbs = [&straight, &bent, &curled, &spring];
        for (i, source) in limbs.iter().enumerate() {
            for (k, target) in limbs.iter().enumerate() {
                let off = off(source, target, &inside());
                assert!(off < 0.03, "limb {i} to limb {k}: {off}");
            }
        }
    }

    #[test]
    fn the_way_back_is_the_inverse() {
        let (a, b) = (limb(|t| 0.05 - 0.2 * t), limb(|t| 0.33 * (25.0 * t).sin()));
        let there = match_curves(&a, &b, &[], &inside()).expect("a match");
        let back = match_curves(&b, &a, &[], &inside()).expect("a match");
        assert_eq!(there.inverse(), back);
    }

    #[test]
    fn a_design_is_found_again_turned_and_enlarged() {
        let shape = limb(|t| 0.33 * (14.0 * t).sin());
        let turn = DVec2::from_angle(2.0);
        let moved = shape
            .points()
            .iter()
            .map(|p| 70.0 * turn.rotate(*p) + DVec2::splat(9.0));
        let moved = Ring::new(moved.collect()).expect("a ring");
        let moved = BoundaryCurve::closed(&moved).expect("a size");
        assert!(off(&shape, &moved, &inside()) < 1e-9);
    }
}
