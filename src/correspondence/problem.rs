//! The search for a match: poses, closed paths, strictly monotone paths.
//!
//! [`super::boundary`] says what is guaranteed. Indices of nodes are counted
//! on over the seams of closed curves: sample n is sample 0 one round on.

use super::boundary_match::BoundaryMatch;
use super::congruent::settled;
use super::curve::Curve;
use super::cyclic::all_starts;
use super::features::{Features, PoseWeights};
use super::options::MatchOptions;
use super::path_grid::{PathGrid, Route, Scratch};
use super::refine::refine;
use super::samples::Samples;
use crate::geometry::DVec2;
use rayon::prelude::*;

/// What turning adds to the cost, relative and absolute, times 1 − cos of the
/// rotation. The relative part settles near ties of unlike designs (a flower
/// of six petals and another); it vanishes for a design against itself, which
/// has to be found again however it was turned.
const REST_RELATIVE: f64 = 0.05;
const REST: f64 = 0.0005;

/// Poses nearer than this count as one, in radians.
const POSE_APART: f64 = 0.35;

/// How many poses are tried besides none.
const POSES: usize = 5;

/// How often the pose of the match found is put in and the match redone.
const POSE_ROUNDS: usize = 3;

/// With so many samples the poses are chosen among by a match of fewer.
const MANY: u32 = 96;

/// Poses whose coarse score is within this factor of the best are tried again.
const NEAR_TIE: f64 = 1.15;

/// A pose so near the rotation of its match is not put right, in radians.
const SAME_POSE: f64 = 0.02;

/// Samples by which the refined path may leave the coarse one.
const REACH: usize = 9;

/// Two sampled curves.
pub(super) struct Problem {
    source: Samples,
    target: Samples,
    source_features: Features,
    target_features: Features,
    pins: Vec<[f64; 2]>,
    stretch: f64,
    thickness: f64,
    keep_up: bool,
    /// The same with fewer samples, to tell which poses are worth a full
    /// search; none where the full one is small.
    coarse: Option<Box<Self>>,
}

/// A path with the comparison it was found by.
struct Solution {
    /// Unit steps, counted on over the seams.
    nodes: Vec<[usize; 2]>,
    unlike: Vec<f64>,
    cost: f64,
    /// The cost and what the rotation adds to it.
    score: f64,
    /// The rotation that was assumed, and the one of the match.
    pose: f64,
    rotation: f64,
}

impl Problem {
    pub fn new(
        source: &Curve,
        target: &Curve,
        pins: Vec<[f64; 2]>,
        options: &MatchOptions,
    ) -> Self {
        let all_pins = pins.clone();
        let fixed = |side: usize| pins.iter().map(|pin| pin[side]).collect::<Vec<_>>();
        let a = Samples::of(source, options.samples, &fixed(0));
        let b = Samples::of(target, options.samples, &fixed(1));
        Self {
            source_features: Features::of(source, &a),
            target_features: Features::of(target, &b),
            source: a,
            target: b,
            pins,
            stretch: options.stretch,
            thickness: options.thickness,
            keep_up: options.keep_up,
            coarse: (options.samples >= MANY).then(|| {
                let samples = options.samples.div_ceil(2).min(MANY);
                let fewer = MatchOptions {
                    samples,
                    ..options.clone()
                };
                Box::new(Self::new(source, target, all_pins, &fewer))
            }),
        }
    }

    /// The match of the two curves, which are those it was made of.
    pub fn solve(self, curves: [&Curve; 2]) -> BoundaryMatch {
        let solution = self.posed_solution();
        let nodes = self.strict(&solution);
        let place = |&[i, j]: &[usize; 2]| {
            let (n, m) = (self.source.places.len(), self.target.places.len());
            [self.source.places[i % n], self.target.places[j % m]]
        };
        let mut knots: Vec<_> = nodes.iter().map(place).collect();
        if self.source.closed {
            knots.pop(); // the first again
        }
        knots.sort_by(|a, b| a[0].total_cmp(&b[0]));
        BoundaryMatch {
            rotation: self.rotation(&nodes),
            knots: settled(&knots, &self.pins, curves).unwrap_or(knots),
            closed: self.source.closed,
            cost: solution.cost,
            pins: self.pins,
        }
    }

    /// The best path over the poses that a search through fewer samples left.
    fn posed_solution(&self) -> Solution {
        let blind = self
            .source_features
            .unlike(&self.target_features, self.thickness);
        if self.keep_up {
            return self.posed(&blind, 0.0, PoseWeights::FIXED);
        }
        let poses = match &self.coarse {
            Some(coarse) => coarse.likely_poses(),
            None => self.poses(&blind),
        };
        let tried = self.solutions(&blind, poses).into_iter();
        let least = |best: Solution, next: Solution| {
            if next.score < best.score { next } else { best }
        };
        let best = tried.reduce(least);
        let mut best = best.unwrap_or_else(|| self.posed(&blind, 0.0, PoseWeights::FREE));
        for _ in 0..POSE_ROUNDS {
            if (best.rotation - best.pose).cos() > SAME_POSE.cos() {
                break;
            }
            let next = self.posed(&blind, best.rotation, PoseWeights::FREE);
            if next.score >= best.score {
                break;
            }
            best = next;
        }
        best
    }

    /// The rotation of the best match, and those of others almost as good.
    fn likely_poses(&self) -> Vec<f64> {
        let blind = self
            .source_features
            .unlike(&self.target_features, self.thickness);
        let mut found = self.solutions(&blind, self.poses(&blind));
        found.sort_by(|a, b| a.score.total_cmp(&b.score));
        let most = found.first().map_or(0.0, |best| NEAR_TIE * best.score);
        let mut poses: Vec<f64> = Vec::new();
        for solution in found.iter().take_while(|found| found.score <= most) {
            if poses.iter().all(|&pose| apart(pose, solution.rotation)) {
                poses.push(solution.rotation);
            }
        }
        poses
    }

    /// The best path at each of some poses.
    fn solutions(&self, blind: &[f64], poses: Vec<f64>) -> Vec<Solution> {
        let posed = |pose| self.posed(blind, pose, PoseWeights::FREE);
        poses.into_par_iter().map(posed).collect()
    }

    fn posed(&self, blind: &[f64], pose: f64, weights: PoseWeights) -> Solution {
        let [a, b] = [&self.source_features, &self.target_features];
        let found = self.best_path(a.unlike_posed(b, blind, pose, weights));
        Solution { pose, ..found }
    }

    /// Rotations worth trying, the likeliest first, none of them near another.
    fn poses(&self, blind: &[f64]) -> Vec<f64> {
        let mut likely: Vec<(f64, f64)> = Vec::new();
        self.visit_paths(blind, |cost, nodes| {
            let rotation = self.rotation(&nodes());
            likely.push((scored(cost, rotation), rotation));
        });
        likely.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut poses: Vec<f64> = Vec::new();
        for (_, pose) in likely {
            if poses.len() < POSES && poses.iter().all(|&p| apart(p, pose)) {
                poses.push(pose);
            }
        }
        if poses.iter().all(|&p| apart(p, 0.0)) {
            poses.push(0.0);
        }
        poses
    }

    fn best_path(&self, unlike: Vec<f64>) -> Solution {
        let mut best: Option<Solution> = None;
        self.visit_paths(&unlike, |cost, nodes| {
            if best.as_ref().is_some_and(|b| cost >= b.score) {
                return; // rotation only adds
            }
            let nodes = nodes();
            let rotation = self.rotation(&nodes);
            let score = scored(cost, rotation);
            if best.as_ref().is_none_or(|b| score < b.score) {
                best = Some(Solution {
                    nodes,
                    unlike: Vec::new(),
                    cost,
                    score,
                    pose: 0.0,
                    rotation,
                });
            }
        });
        let best = best.unwrap_or_else(|| unreachable!("there is a path for each start"));
        Solution { unlike, ..best }
    }

    /// Visits cost and nodes of the cheapest path of each start; of the one
    /// path where pins or ends leave no choice.
    fn visit_paths(
        &self,
        unlike: &[f64],
        mut visit: impl FnMut(f64, &dyn Fn() -> Vec<[usize; 2]>),
    ) {
        let fixed = self.fixed_nodes();
        if let Some(&first) = fixed.first() {
            let mut nodes = vec![first];
            let mut cost = 0.0;
            for ends in fixed.windows(2) {
                let grid = self.grid(unlike, ends[0], ends[1]);
                let width = grid.source.len() - 1;
                let route =
                    (grid.prices()).shortest([0, width], |_| [0, width], &mut Scratch::default());
                cost += route.cost;
                nodes.extend(moved(&route, ends[0]).skip(1));
            }
            return visit(cost, &|| nodes.clone());
        }
        let (n, m) = (self.source.steps(), self.target.steps());
        let grid = self.grid(unlike, [0, 0], [2 * n, m]);
        for route in all_starts(&grid.prices(), n) {
            visit(route.cost, &|| route.nodes());
        }
    }

    /// Nodes that every path visits, ascending, from a first one to its like
    /// one round on; none where closed curves have no pins.
    fn fixed_nodes(&self) -> Vec<[usize; 2]> {
        let (n, m) = (self.source.steps(), self.target.steps());
        let node =
            |pin: &[f64; 2]| Some([self.source.index_of(pin[0])?, self.target.index_of(pin[1])?]);
        let mut nodes: Vec<[usize; 2]> = self.pins.iter().filter_map(node).collect();
        if self.source.closed {
            if let Some(&first) = nodes.first() {
                for node in &mut nodes {
                    if node[1] < first[1] {
                        node[1] += m;
                    }
                }
                nodes.push([first[0] + n, first[1] + m]);
            }
        } else {
            nodes.extend([[0, 0], [n, m]]);
            nodes.sort_unstable();
            nodes.dedup();
        }
        nodes
    }

    /// The window of pairs from one node to another, both included.
    fn grid(&self, unlike: &[f64], from: [usize; 2], to: [usize; 2]) -> PathGrid {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let place = |samples: &Samples, k: usize| samples.unrolled(k);
        let mut window = Vec::with_capacity((to[0] + 1 - from[0]) * (to[1] + 1 - from[1]));
        for j in from[1]..=to[1] {
            let round = &unlike[(j % m) * n..][..n];
            window.extend((from[0]..=to[0]).map(|i| round[i % n]));
        }
        PathGrid {
            source: (from[0]..=to[0]).map(|i| place(&self.source, i)).collect(),
            target: (from[1]..=to[1]).map(|j| place(&self.target, j)).collect(),
            unlike: window,
            stretch: self.stretch,
        }
    }

    /// The rotation of the source's matched points onto the target's.
    fn rotation(&self, nodes: &[[usize; 2]]) -> f64 {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let mut sum = DVec2::ZERO;
        for step in nodes.windows(2) {
            let [[a, b], [i, j]] = [step[0], step[1]];
            let walked = self.source.unrolled(i) - self.source.unrolled(a)
                + self.target.unrolled(j)
                - self.target.unrolled(b);
            for [i, j] in [[a, b], [i, j]] {
                let p = self.source_features.position(i % n);
                let q = self.target_features.position(j % m);
                sum += walked * DVec2::new(p.dot(q), p.perp_dot(q));
            }
        }
        // Shapes without a direction of their own are not turned.
        if sum.length() < 1e-9 {
            0.0
        } else {
            sum.to_angle()
        }
    }

    /// The solution as a strictly monotone path. A closed one without pins is
    /// cut at its most telling node, then at the far side, to leave no trace
    /// of the cut.
    fn strict(&self, solution: &Solution) -> Vec<[usize; 2]> {
        let fixed = self.fixed_nodes();
        if fixed.is_empty() {
            let start = self.most_telling(solution);
            let first = self.refined(solution, &self.cut_at(&solution.nodes, start));
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
    fn refined(&self, solution: &Solution, nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
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
    fn most_telling(&self, solution: &Solution) -> [usize; 2] {
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
        let (n, m) = (self.source.steps(), self.target.steps());
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

/// The nodes of a route in a window that starts at `from`.
fn moved(route: &Route, from: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let nodes = route.nodes().into_iter();
    nodes.map(move |[i, j]| [i + from[0], j + from[1]])
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

/// The cost with what the rotation adds.
fn scored(cost: f64, rotation: f64) -> f64 {
    cost + (REST_RELATIVE * cost + REST) * (1.0 - rotation.cos())
}

fn apart(a: f64, b: f64) -> bool {
    (a - b).cos() < POSE_APART.cos()
}
