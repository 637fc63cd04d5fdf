//! The rotations of one design onto the other that are worth a search, and
//! the best path over them.

use super::curve_problem::CurveMatchProblem;
use super::features::PoseWeights;
use rayon::prelude::*;

/// What turning adds to the cost, relative and absolute, times 1 − cos of the
/// rotation. The relative part settles near ties of unlike designs (a flower
/// of six petals and another); it vanishes for a design against itself, which
/// has to be found again however it was turned.
const REST_RELATIVE: f64 = 0.05;
const REST: f64 = 0.0005;

/// Poses nearer than this count as one, in radians.
/// 20°: within that a search finds the pose by its own rounds.
const POSE_APART: f64 = 0.35;

/// How many poses are tried besides none.
const POSES: usize = 5;

/// How often the pose of the match found is put in and the match redone.
const POSE_ROUNDS: usize = 3;

/// Poses whose coarse score is within this factor of the best are tried again.
const NEAR_TIE: f64 = 1.15;

/// A pose so near the rotation of its match is not put right, in radians.
const SAME_POSE: f64 = 0.02;

/// A path with the comparison it was found by.
pub(super) struct PathSolution {
    /// Unit steps, counted on over the seams.
    pub(super) nodes: Vec<[usize; 2]>,
    pub(super) unlike: Vec<f64>,
    pub(super) cost: f64,
    /// The cost and what the rotation adds to it.
    score: f64,
    /// The rotation that was assumed, and the one of the match.
    pose: f64,
    rotation: f64,
}

impl CurveMatchProblem {
    /// The best path over the poses that a search through fewer samples left.
    pub(super) fn posed_solution(&self) -> PathSolution {
        let blind = self.blind();
        if self.keep_up {
            return self.posed(&blind, 0.0, PoseWeights::FIXED);
        }
        // A coarse search tells which of many poses are worth a full one.
        let poses = match &self.coarse {
            Some(coarse) => coarse.likely_poses(),
            None => self.poses(&blind),
        };
        let tried = self.solutions(&blind, poses).into_iter();
        let least = |best: PathSolution, next: PathSolution| {
            if next.score < best.score { next } else { best }
        };
        let best = tried.reduce(least);
        let mut best = best.unwrap_or_else(|| self.posed(&blind, 0.0, PoseWeights::FREE));
        for _ in 0..POSE_ROUNDS {
            if (best.rotation - best.pose).cos() > SAME_POSE.cos() {
                break;
            }
            // The pose was a guess; that of its match is a better one.
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
        let blind = self.blind();
        let mut found = self.solutions(&blind, self.poses(&blind));
        found.sort_by(|a, b| a.score.total_cmp(&b.score));
        let most = found.first().map_or(0.0, |best| NEAR_TIE * best.score);
        let good = found.iter().take_while(|found| found.score <= most);
        distinct(good.map(|solution| solution.rotation))
    }

    /// How unlike samples are where no pose is guessed.
    pub(super) fn unposed(&self) -> Vec<f64> {
        let blind = self.blind();
        if !self.keep_up {
            return blind;
        }
        let [a, b] = [&self.source_features, &self.target_features];
        a.unlike_posed(b, &blind, 0.0, PoseWeights::FIXED)
    }

    /// How unlike samples are whatever the pose.
    fn blind(&self) -> Vec<f64> {
        (self.source_features).unlike(&self.target_features, self.thickness)
    }

    /// The best path at each of some poses.
    fn solutions(&self, blind: &[f64], poses: Vec<f64>) -> Vec<PathSolution> {
        let posed = |pose| self.posed(blind, pose, PoseWeights::FREE);
        poses.into_par_iter().map(posed).collect()
    }

    fn posed(&self, blind: &[f64], pose: f64, weights: PoseWeights) -> PathSolution {
        let [a, b] = [&self.source_features, &self.target_features];
        let found = self.best_path(a.unlike_posed(b, blind, pose, weights));
        PathSolution { pose, ..found }
    }

    /// Rotations worth trying, the likeliest first, none of them near another.
    fn poses(&self, blind: &[f64]) -> Vec<f64> {
        let mut likely: Vec<(f64, f64)> = Vec::new();
        self.visit_paths(blind, |cost, nodes| {
            let rotation = self.rotation(&nodes());
            likely.push((scored(cost, rotation), rotation));
        });
        likely.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut poses = distinct(likely.into_iter().map(|(_, pose)| pose));
        poses.truncate(POSES);
        // As drawn is always tried: most pairs are drawn upright.
        if poses.iter().all(|&p| apart(p, 0.0)) {
            poses.push(0.0);
        }
        poses
    }

    /// The best path by how unlike samples are, over all starts.
    pub(super) fn best_path(&self, unlike: Vec<f64>) -> PathSolution {
        let mut best: Option<PathSolution> = None;
        self.visit_paths(&unlike, |cost, nodes| {
            if best.as_ref().is_some_and(|b| cost >= b.score) {
                return; // rotation only adds
            }
            let nodes = nodes();
            let rotation = self.rotation(&nodes);
            let score = scored(cost, rotation);
            if best.as_ref().is_none_or(|b| score < b.score) {
                best = Some(PathSolution {
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
        PathSolution { unlike, ..best }
    }
}

/// The cost with what the rotation adds.
fn scored(cost: f64, rotation: f64) -> f64 {
    cost + (REST_RELATIVE * cost + REST) * (1.0 - rotation.cos())
}

/// Those of some poses that are not near an earlier one.
fn distinct(poses: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for pose in poses {
        if kept.iter().all(|&other| apart(other, pose)) {
            kept.push(pose);
        }
    }
    kept
}

fn apart(a: f64, b: f64) -> bool {
    (a - b).cos() < POSE_APART.cos()
}
