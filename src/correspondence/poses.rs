//! Selects a few likely poses (rotations of one design onto the other), searches for the best path
//! through sample pairs with each of them, and returns the best of these paths.

use super::curve_problem::CurveMatchProblem;
use super::features::PoseWeights;
use rayon::prelude::*;

/// Relative penalty on rotation: a path of cost c and rotation φ has the score c +
/// (`RELATIVE_ROTATION_PENALTY` · c + `ROTATION_PENALTY`) · (1 − cos φ). The relative part decides
/// between almost equal costs if both designs are symmetric but differ, such as two flowers with
/// six petals. It vanishes if a design is matched with itself, which must succeed at any rotation
/// (heuristic).
const RELATIVE_ROTATION_PENALTY: f64 = 0.05;
/// Absolute penalty on rotation, added to the relative one (heuristic).
const ROTATION_PENALTY: f64 = 0.0005;

/// Poses that differ by less than this angle count as one, because searches from them end in the
/// same pose; in radians, 20° (heuristic).
const MIN_POSE_DISTANCE: f64 = 0.35;

/// Maximum number of poses tried, before rotation 0 is added if it is not among them (resource
/// limit).
const MAX_POSES: usize = 5;

/// Maximum number of times that the search is repeated with the rotation of the last match as the
/// pose (resource limit).
const POSE_ROUNDS: usize = 3;

/// A pose is searched again with all samples if its score in the coarse search is at most this
/// multiple of the best score there (heuristic).
const NEAR_TIE: f64 = 1.15;

/// A search for a path has converged if the rotation of its match differs from the assumed pose by
/// less than this angle, in radians (tolerance: about one degree).
const SAME_POSE: f64 = 0.02;

/// A closed path through sample pairs, and the dissimilarities for which the search found it.
pub(super) struct PathSolution {
    /// Nodes of the path: pairs of sample indices `[source, target]`, each one unit step after the
    /// previous one. The indices continue from round to round.
    pub(super) nodes: Vec<[usize; 2]>,
    /// Dissimilarities of all sample pairs that the search used, one row for each target sample.
    pub(super) dissimilarity: Vec<f64>,
    /// Sum of the path's bending and stretching costs.
    pub(super) cost: f64,
    /// `cost` plus the penalty on rotation.
    score: f64,
    /// Rotation of the source onto the target that the search assumed, in radians.
    pose: f64,
    /// Rotation that best aligns the points matched by the path, in radians.
    rotation: f64,
}

impl CurveMatchProblem {
    /// Returns the best path found from any likely rotation; if the designs stay upright, the best
    /// path for rotation 0.
    ///
    /// A search with fewer samples selects the likely rotations. The best path is then refined by
    /// further searches, each of which starts from the rotation of the last match.
    pub(super) fn posed_solution(&self) -> PathSolution {
        let invariant = self.invariant_dissimilarities();
        if self.keep_up {
            return self.path_for_pose(&invariant, 0.0, PoseWeights::FIXED);
        }
        // The coarse search selects the few poses that are worth a full search.
        let poses = match &self.coarse {
            Some(coarse) => coarse.likely_poses(),
            None => self.candidate_poses(&invariant),
        };
        let candidates = self.solutions(&invariant, poses).into_iter();
        let better = |best: PathSolution, next: PathSolution| {
            if next.score < best.score { next } else { best }
        };
        let best = candidates.reduce(better);
        let mut best =
            best.unwrap_or_else(|| self.path_for_pose(&invariant, 0.0, PoseWeights::FREE));
        for _ in 0..POSE_ROUNDS {
            if (best.rotation - best.pose).cos() > SAME_POSE.cos() {
                break;
            }
            // The rotation of the match found is a better estimate than the pose that the search
            // assumed.
            let next = self.path_for_pose(&invariant, best.rotation, PoseWeights::FREE);
            if next.score >= best.score {
                break;
            }
            best = next;
        }
        best
    }

    /// Returns the rotations of the best match and of other matches with almost as good a score.
    fn likely_poses(&self) -> Vec<f64> {
        let invariant = self.invariant_dissimilarities();
        let mut solutions = self.solutions(&invariant, self.candidate_poses(&invariant));
        solutions.sort_by(|a, b| a.score.total_cmp(&b.score));
        let max_score = solutions.first().map_or(0.0, |best| NEAR_TIE * best.score);
        let accepted = solutions
            .iter()
            .take_while(|solution| solution.score <= max_score);
        distinct_poses(accepted.map(|solution| solution.rotation))
    }

    /// Returns the dissimilarities for searches that do not estimate a pose. They are
    /// rotation-invariant, except that with `keep_up` tangents and positions as drawn count too.
    pub(super) fn pose_free_dissimilarities(&self) -> Vec<f64> {
        let invariant = self.invariant_dissimilarities();
        if !self.keep_up {
            return invariant;
        }
        let [a, b] = [&self.source_features, &self.target_features];
        a.posed_dissimilarities(b, &invariant, 0.0, PoseWeights::FIXED)
    }

    /// Returns the dissimilarities that do not depend on a rotation, of all pairs of samples, one
    /// row for each target sample.
    fn invariant_dissimilarities(&self) -> Vec<f64> {
        (self.source_features).dissimilarities(&self.target_features, self.thickness)
    }

    /// Returns the best path for each of the given poses.
    fn solutions(&self, invariant: &[f64], poses: Vec<f64>) -> Vec<PathSolution> {
        let posed = |pose| self.path_for_pose(invariant, pose, PoseWeights::FREE);
        poses.into_par_iter().map(posed).collect()
    }

    /// Returns the best path for one pose.
    fn path_for_pose(&self, invariant: &[f64], pose: f64, weights: PoseWeights) -> PathSolution {
        let [a, b] = [&self.source_features, &self.target_features];
        let found = self.best_path(a.posed_dissimilarities(b, invariant, pose, weights));
        PathSolution { pose, ..found }
    }

    /// Returns the rotations worth trying, most likely first, no two of them close to each other.
    fn candidate_poses(&self, invariant: &[f64]) -> Vec<f64> {
        let mut likely: Vec<(f64, f64)> = Vec::new();
        self.visit_paths(invariant, |cost, nodes| {
            let rotation = self.rotation(&nodes());
            likely.push((score(cost, rotation), rotation));
        });
        likely.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut poses = distinct_poses(likely.into_iter().map(|(_, pose)| pose));
        poses.truncate(MAX_POSES);
        // Rotation 0 is always tried: most pairs are drawn upright.
        if poses.iter().all(|&p| are_apart(p, 0.0)) {
            poses.push(0.0);
        }
        poses
    }

    /// Returns the path with the lowest score over all starting samples.
    pub(super) fn best_path(&self, dissimilarities: Vec<f64>) -> PathSolution {
        let mut best: Option<PathSolution> = None;
        self.visit_paths(&dissimilarities, |cost, nodes| {
            if best.as_ref().is_some_and(|b| cost >= b.score) {
                return; // the penalty on rotation is not negative
            }
            let nodes = nodes();
            let rotation = self.rotation(&nodes);
            let score = score(cost, rotation);
            if best.as_ref().is_none_or(|b| score < b.score) {
                best = Some(PathSolution {
                    nodes,
                    dissimilarity: Vec::new(),
                    cost,
                    score,
                    pose: 0.0,
                    rotation,
                });
            }
        });
        let best = best.unwrap_or_else(|| unreachable!("there is a path for each start"));
        PathSolution {
            dissimilarity: dissimilarities,
            ..best
        }
    }
}

/// Returns the cost plus the penalty on rotation.
fn score(cost: f64, rotation: f64) -> f64 {
    cost + (RELATIVE_ROTATION_PENALTY * cost + ROTATION_PENALTY) * (1.0 - rotation.cos())
}

/// Returns the poses, without those that are close to an earlier pose.
fn distinct_poses(poses: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut distinct: Vec<f64> = Vec::new();
    for pose in poses {
        if distinct.iter().all(|&other| are_apart(other, pose)) {
            distinct.push(pose);
        }
    }
    distinct
}

/// Returns whether two rotations differ by more than [`MIN_POSE_DISTANCE`].
fn are_apart(a: f64, b: f64) -> bool {
    (a - b).cos() < MIN_POSE_DISTANCE.cos()
}
