//! Matches two boundaries by the inner distances of their samples.
//!
//! Two samples are dissimilar if their inner distances to corresponding samples differ. The
//! correspondence is not known at first, so the first path compares each sample's inner distances
//! to places evenly spaced along the boundary (Ling, Jacobs 2007). Each path then supplies
//! corresponding samples for the next. This alternation approximates the Gromov–Wasserstein
//! comparison of two metrics (Mémoli 2011), with the cyclic dynamic program in place of optimal
//! transport.
//!
//! Guaranteed: deterministic. Not guaranteed: the best of all paths; the alternation stops when the
//! cost no longer decreases, or after a fixed number of rounds.

use super::curve_problem::CurveMatchProblem;
use super::inner_descriptors::{AHEAD, inner_dissimilarities};
use super::poses::PathSolution;

/// Minimum distance along a path between two reference pairs (pairs of corresponding samples to
/// which inner distances are measured), as the sum of the fractions of both curves' lengths: about
/// 160 pairs in all (heuristic).
const MIN_PAIR_DISTANCE: f64 = 0.012;

/// Maximum number of rounds in which each path supplies the reference pairs (pairs of samples to
/// which inner distances are measured) for the next path (resource limit).
const MAX_ROUNDS: usize = 6;

impl CurveMatchProblem {
    /// Returns the best path found by comparing inner distances. Returns `None` if the weight of
    /// inner distances is zero, or if a curve has no inside.
    pub(super) fn inner_distance_solution(&self) -> Option<PathSolution> {
        let Some(coarse) = &self.coarse else {
            return self.alternated_inner_solution();
        };
        // The coarse problem finds the correspondence; the full one then refines it in a single
        // round.
        let found = coarse.alternated_inner_solution()?;
        self.path_by_pairs(&coarse.transfer_path(&found.nodes, self))
    }

    /// Alternates between two steps until the cost no longer decreases: finds the best path for
    /// given reference pairs (pairs of samples to which inner distances are measured), and takes
    /// new reference pairs from that path.
    fn alternated_inner_solution(&self) -> Option<PathSolution> {
        let [a, b] = self.inner_descriptors.as_ref()?;
        let rows = [
            a.distances_ahead(&self.source),
            b.distances_ahead(&self.target),
        ];
        let dissimilarities = inner_dissimilarities(&rows[0], &rows[1], &[1.0; AHEAD as usize]);
        let first = self.path_by_inner_distances(&dissimilarities);
        let mut best = self.path_by_pairs(&first.nodes)?;
        for _ in 1..MAX_ROUNDS {
            let next = self.path_by_pairs(&best.nodes)?;
            if next.cost >= best.cost {
                break;
            }
            best = next;
        }
        Some(best)
    }

    /// Takes reference pairs (pairs of samples) from the path `nodes`, compares samples by their
    /// inner distances to these pairs, and returns the best path. Returns `None` without inner
    /// distances.
    fn path_by_pairs(&self, nodes: &[[usize; 2]]) -> Option<PathSolution> {
        let [a, b] = self.inner_descriptors.as_ref()?;
        let (pairs, weights) = self.reference_pairs(nodes);
        let rows = [
            a.distances_to(pairs.iter().map(|pair| pair[0])),
            b.distances_to(pairs.iter().map(|pair| pair[1])),
        ];
        Some(self.path_by_inner_distances(&inner_dissimilarities(&rows[0], &rows[1], &weights)))
    }

    /// Returns the best path for the sum of the boundary features' dissimilarities and the weighted
    /// inner-distance dissimilarities `inner`.
    fn path_by_inner_distances(&self, inner: &[f64]) -> PathSolution {
        let combined = self.pose_free_dissimilarities().into_iter().zip(inner);
        self.best_path(
            combined
                .map(|(boundary, inner)| boundary + self.inner_weight * inner)
                .collect(),
        )
    }

    /// Returns the reference pairs of a closed path: pairs of its samples, each at least
    /// [`MIN_PAIR_DISTANCE`] after the previous one. Also returns, for each pair, the length of the
    /// path since the previous pair or the path's start.
    fn reference_pairs(&self, nodes: &[[usize; 2]]) -> (Vec<[usize; 2]>, Vec<f64>) {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let position =
            |[i, j]: [usize; 2]| self.source.unwrapped_place(i) + self.target.unwrapped_place(j);
        let (mut pairs, mut weights) = (Vec::new(), Vec::new());
        let mut last_position = position(nodes[0]);
        for &node in &nodes[1..] {
            let length = position(node) - last_position;
            if length >= MIN_PAIR_DISTANCE {
                pairs.push([node[0] % n, node[1] % m]);
                weights.push(length);
                last_position = position(node);
            }
        }
        (pairs, weights)
    }

    /// Converts a path to the samples of `to`, another problem with the same curves: each node
    /// becomes the pair of the nearest samples of `to`.
    fn transfer_path(&self, nodes: &[[usize; 2]], to: &Self) -> Vec<[usize; 2]> {
        let resampled = |&[i, j]: &[usize; 2]| {
            [
                to.source.nearest(self.source.unwrapped_place(i)),
                to.target.nearest(self.target.unwrapped_place(j)),
            ]
        };
        nodes.iter().map(resampled).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::boundary::match_curves;
    use super::super::boundary_match::interpolate_knots;
    use super::super::curve::BoundaryCurve;
    use super::super::options::MatchOptions;
    use crate::geometry::{DVec2, Ring};

    /// Number of points on each side of a limb.
    const SIDE: usize = 61;

    /// Creates a tapering limb whose centre line turns by `turn(t)` radians at each of its points,
    /// with t from 0 to 1 along the limb. Point k is the same material point in every limb.
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

    /// Returns the largest distance between the place matched with a point and the place of its
    /// true counterpart, as a fraction of the target's length.
    fn max_error(source: &BoundaryCurve, target: &BoundaryCurve, options: &MatchOptions) -> f64 {
        let matched = match_curves(source, target, &[], options).expect("a match");
        let mut knots = matched.knots().to_vec();
        for k in 1..knots.len() {
            if knots[k][1] < knots[0][1] {
                knots[k][1] += 1.0;
            }
        }
        knots.push(knots[0].map(|place| place + 1.0));
        let mut worst: f64 = 0.0;
        for (a, b) in source.places().iter().zip(target.places()) {
            let round = f64::from(u8::from(*a < knots[0][0]));
            let error = interpolate_knots(&knots, a + round, [0, 1]) - b;
            worst = worst.max((error - error.round()).abs());
        }
        worst
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn limbs_match_however_they_bend() {
        let straight = limb(|_| 0.0);
        let bent = limb(|t| if t < 0.5 { 0.09 } else { -0.09 });
        let curled = limb(|t| 0.16 - 0.1 * t);
        let spring = limb(|t| 0.33 * (25.0 * t).sin());
        let limbs = [&straight, &bent, &curled, &spring];
        for (i, source) in limbs.iter().enumerate() {
            for (k, target) in limbs.iter().enumerate() {
                let error = max_error(source, target, &inside());
                assert!(error < 0.03, "limb {i} to limb {k}: {error}");
            }
        }
    }

    #[test]
    fn the_reverse_match_is_the_inverse() {
        let (a, b) = (limb(|t| 0.05 - 0.2 * t), limb(|t| 0.33 * (25.0 * t).sin()));
        let there = match_curves(&a, &b, &[], &inside()).expect("a match");
        let back = match_curves(&b, &a, &[], &inside()).expect("a match");
        assert_eq!(there.inverse(), back);
    }

    #[test]
    fn a_shape_matches_itself_rotated_and_scaled() {
        let shape = limb(|t| 0.33 * (14.0 * t).sin());
        let turn = DVec2::from_angle(2.0);
        let moved = shape
            .points()
            .iter()
            .map(|p| 70.0 * turn.rotate(*p) + DVec2::splat(9.0));
        let moved = Ring::new(moved.collect()).expect("a ring");
        let moved = BoundaryCurve::closed(&moved).expect("a size");
        assert!(max_error(&shape, &moved, &inside()) < 1e-9);
    }
}
