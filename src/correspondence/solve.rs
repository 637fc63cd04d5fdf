//! Solves the matching of two curves: finds the best path through sample pairs, makes it strictly
//! monotone, and refines it for curves that are nearly congruent up to a similarity.

use super::boundary_match::BoundaryMatch;
use super::congruent::registered_knots;
use super::curve::BoundaryCurve;
use super::curve_problem::CurveMatchProblem;
use super::monotone_path::refine;
use super::poses::PathSolution;

/// Maximum distance of the strictly monotone path from the unit-step path, in samples (derived: one
/// more than the longest step of the strictly monotone path).
const REACH: usize = 9;

impl CurveMatchProblem {
    /// Returns the match of the two curves, which must be those that the problem was created from.
    pub fn solve(self, curves: [&BoundaryCurve; 2]) -> BoundaryMatch {
        let inside = self.inner_distance_solution();
        let solution = inside.unwrap_or_else(|| self.posed_solution());
        let nodes = self.strictly_monotone(&solution);
        let place = |&[i, j]: &[usize; 2]| {
            let (n, m) = (self.source.places.len(), self.target.places.len());
            [self.source.places[i % n], self.target.places[j % m]]
        };
        let mut knots: Vec<_> = nodes.iter().map(place).collect();
        knots.pop(); // repeats the first
        knots.sort_by(|a, b| a[0].total_cmp(&b[0]));
        BoundaryMatch {
            rotation: self.rotation(&nodes),
            knots: registered_knots(&knots, &self.pins, curves).unwrap_or(knots),
            cost: solution.cost,
            pins: self.pins,
        }
    }

    /// Converts the solution to a strictly monotone path. A closed path without pins is refined
    /// twice: first from its most distinctive node, then from the opposite node. The second
    /// refinement removes the traces of the fixed start of the first.
    fn strictly_monotone(&self, solution: &PathSolution) -> Vec<[usize; 2]> {
        let fixed = self.fixed_nodes();
        if fixed.is_empty() {
            let start = self.most_distinctive_node(solution);
            let first =
                self.refine_section(solution, &self.rotated_to_start(&solution.nodes, start));
            // The refined path has longer steps, so expand it to unit steps before the second
            // refinement.
            let expanded = unit_steps(&first);
            let far = first[first.len() / 2];
            return self.refine_section(solution, &self.rotated_to_start(&expanded, far));
        }
        let mut strict = vec![fixed[0]];
        for pair in fixed.windows(2) {
            let position = |node| solution.nodes.iter().position(|n| *n == node);
            if let (Some(from), Some(to)) = (position(pair[0]), position(pair[1])) {
                strict.extend(
                    self.refine_section(solution, &solution.nodes[from..=to])
                        .into_iter()
                        .skip(1),
                );
            }
        }
        strict
    }

    /// Makes a section of a path strictly monotone; its first and last nodes stay fixed.
    fn refine_section(&self, solution: &PathSolution, nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
        let [from, to] = [nodes[0], nodes[nodes.len() - 1]];
        let grid = self.grid(&solution.dissimilarity, from, to);
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

    /// Returns the node at which both curves bend most strongly and are most similar.
    fn most_distinctive_node(&self, solution: &PathSolution) -> [usize; 2] {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let distinctiveness = |&[i, j]: &[usize; 2]| {
            let (i, j) = (i % n, j % m);
            let bend = (self.source_features.salience(i)).min(self.target_features.salience(j));
            // The factor 4 makes similarity dominate over bending (heuristic).
            bend - 4.0 * solution.dissimilarity[j * n + i]
        };
        let mut best = solution.nodes[0];
        for node in &solution.nodes {
            if distinctiveness(node) > distinctiveness(&best) {
                best = *node;
            }
        }
        best
    }

    /// Rotates a closed path so that it runs from node `start` to the same node one round later.
    fn rotated_to_start(&self, nodes: &[[usize; 2]], start: [usize; 2]) -> Vec<[usize; 2]> {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let index = nodes.iter().position(|node| *node == start).unwrap_or(0);
        let ahead = nodes[index..nodes.len() - 1].iter().copied();
        let next_round = nodes[..=index].iter().map(|&[i, j]| [i + n, j + m]);
        let mut path: Vec<_> = ahead.chain(next_round).collect();
        let rounds = [path[0][0] / n, path[0][1] / m];
        for node in &mut path {
            *node = [node[0] - rounds[0] * n, node[1] - rounds[1] * m];
        }
        path
    }
}

/// Replaces each longer step by unit steps along the straight line between its ends.
fn unit_steps(nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut expanded = vec![nodes[0]];
    for step in nodes.windows(2) {
        let [di, dj] = [step[1][0] - step[0][0], step[1][1] - step[0][1]];
        let count = di.max(dj);
        let at = |k: usize| [step[0][0] + di * k / count, step[0][1] + dj * k / count];
        expanded.extend((1..=count).map(at));
    }
    expanded
}
