//! The match of two curves: the best path made strictly monotone, and nearly
//! equal curves settled upon each other.

use super::boundary_match::BoundaryMatch;
use super::congruent::registered_knots;
use super::curve::BoundaryCurve;
use super::curve_problem::CurveMatchProblem;
use super::monotone_path::refine;
use super::poses::PathSolution;

/// Samples by which the refined path may leave the coarse one.
/// One more than the longest step of the refinement.
const REACH: usize = 9;

impl CurveMatchProblem {
    /// The match of the two curves, which are those it was made of.
    pub fn solve(self, curves: [&BoundaryCurve; 2]) -> BoundaryMatch {
        let inside = self.solution_inside();
        let solution = inside.unwrap_or_else(|| self.posed_solution());
        let nodes = self.strict(&solution);
        let place = |&[i, j]: &[usize; 2]| {
            let (n, m) = (self.source.places.len(), self.target.places.len());
            [self.source.places[i % n], self.target.places[j % m]]
        };
        let mut knots: Vec<_> = nodes.iter().map(place).collect();
        knots.pop(); // the first again
        knots.sort_by(|a, b| a[0].total_cmp(&b[0]));
        BoundaryMatch {
            rotation: self.rotation(&nodes),
            knots: registered_knots(&knots, &self.pins, curves).unwrap_or(knots),
            cost: solution.cost,
            pins: self.pins,
        }
    }

    /// The solution as a strictly monotone path. One without pins is
    /// cut at its most telling node, then at the far side, to leave no trace
    /// of the cut.
    fn strict(&self, solution: &PathSolution) -> Vec<[usize; 2]> {
        let fixed = self.fixed_nodes();
        if fixed.is_empty() {
            let start = self.most_telling(solution);
            let first = self.refined(solution, &self.cut_at(&solution.nodes, start));
            // The far side is cut in the refined path, whose steps are longer than one.
            let filled = unit_steps(&first);
            let far = first[first.len() / 2];
            return self.refined(solution, &self.cut_at(&filled, far));
        }
        let mut strict = vec![fixed[0]];
        for ends in fixed.windows(2) {
            let position = |node| solution.nodes.iter().position(|n| *n == node);
            if let (Some(from), Some(to)) = (position(ends[0]), position(ends[1])) {
                strict.extend(
                    self.refined(solution, &solution.nodes[from..=to])
                        .into_iter()
                        .skip(1),
                );
            }
        }
        strict
    }

    /// A stretch of a path refined; its ends stay.
    fn refined(&self, solution: &PathSolution, nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
        let [from, to] = [nodes[0], nodes[nodes.len() - 1]];
        let grid = self.grid(&solution.unlike, from, to);
        let local: Vec<_> = nodes
            .iter()
            .map(|n| [n[0] - from[0], n[1] - from[1]])
            .collect();
        let refined = refine(&grid, &local, REACH);
        refined
            .iter()
            .map(|n| [n[0] + from[0], n[1] + from[1]])
            .collect()
    }

    /// The node of a path that is bent most, and alike, in both.
    fn most_telling(&self, solution: &PathSolution) -> [usize; 2] {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let tells = |&[i, j]: &[usize; 2]| {
            let (i, j) = (i % n, j % m);
            let bent = (self.source_features.salience(i)).min(self.target_features.salience(j));
            bent - 4.0 * solution.unlike[j * n + i]
        };
        let mut best = solution.nodes[0];
        for node in &solution.nodes {
            if tells(node) > tells(&best) {
                best = *node;
            }
        }
        best
    }

    /// A closed path from one of its nodes to the same one round on.
    fn cut_at(&self, nodes: &[[usize; 2]], start: [usize; 2]) -> Vec<[usize; 2]> {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let at = nodes.iter().position(|node| *node == start).unwrap_or(0);
        let ahead = nodes[at..nodes.len() - 1].iter().copied();
        let behind = nodes[..=at].iter().map(|&[i, j]| [i + n, j + m]);
        let mut path: Vec<_> = ahead.chain(behind).collect();
        let rounds = [path[0][0] / n, path[0][1] / m];
        for node in &mut path {
            *node = [node[0] - rounds[0] * n, node[1] - rounds[1] * m];
        }
        path
    }
}

/// Longer steps as unit steps along the straight line.
fn unit_steps(nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut filled = vec![nodes[0]];
    for step in nodes.windows(2) {
        let [di, dj] = [step[1][0] - step[0][0], step[1][1] - step[0][1]];
        let pieces = di.max(dj);
        let at = |k: usize| [step[0][0] + di * k / pieces, step[0][1] + dj * k / pieces];
        filled.extend((1..=pieces).map(at));
    }
    filled
}
