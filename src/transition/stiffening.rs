//! Removes folds from a motion by stiffening faces, where that is possible.
//!
//! A face that follows its local map exactly never folds; it folds where its neighbours pull it
//! elsewhere. Folded faces are therefore stiffened repeatedly until none folds or it no longer
//! helps. Both ends stay exact, since there every face equals its local map.
//!
//! The motion is sampled at [`STEPS`] steps; folds between two steps are missed. Not guaranteed:
//! where large areas fold, stiffness only moves the fold elsewhere.

use super::error::BuildError;
use crate::geometry::orient2d;
use crate::warp::{Arap, Warp};
use crate::work::progress::{Progress, check_cancelled};
use rayon::prelude::*;

/// Number of even time steps at which folds are detected (resource limit).
const STEPS: u32 = 64;

/// Maximum number of times that stiffness is raised (resource limit).
const MAX_ROUNDS: u32 = 8;
/// Factor by which the stiffness of a folded face is raised each time (heuristic).
const STIFFNESS_FACTOR: f64 = 4.0;

/// Maximum number of faces for which folds are detected (resource limit: a round takes 0.4 s per
/// 100,000 faces).
const MAX_FACES: usize = 100_000;

/// Returns the motion with the fewest folds among those that were tried.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn stiffen_folds(motion: Arap, progress: &dyn Progress) -> Result<Arap, BuildError> {
    if motion.mesh().faces().len() > MAX_FACES {
        return Ok(motion);
    }
    let mut folded = folds(&motion);
    if folded.is_empty() || !motion.options().homotopy.keeps_orientation() {
        return Ok(motion);
    }
    let mut stiffness = motion.stiffness().to_vec();
    stiffness.resize(motion.mesh().faces().len(), 1.0);
    let (mut best, mut fewest_folds) = (motion, folded.len());
    for _ in 0..MAX_ROUNDS {
        check_cancelled(progress)?;
        folded.sort_unstable();
        folded.dedup();
        for &face in &folded {
            stiffness[face] *= STIFFNESS_FACTOR;
        }
        let Ok(stiffer) = best.with_stiffness(&stiffness, progress) else {
            break;
        };
        folded = folds(&stiffer);
        if folded.len() < fewest_folds {
            fewest_folds = folded.len();
            best = stiffer;
        }
        if folded.is_empty() {
            break;
        }
    }
    check_cancelled(progress)?;
    Ok(best)
}

/// Returns the faces that are not positively oriented, once for each step at which they are not.
fn folds(motion: &Arap) -> Vec<usize> {
    let folded_at = |step: u32| {
        let mut placer = motion.placer();
        placer.place(f64::from(step) / f64::from(STEPS));
        let positions = &placer.placement().in_frame;
        let is_folded = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| positions[v as usize]);
            orient2d(a, b, c) <= 0.0
        };
        let faces = motion.mesh().faces().iter().enumerate();
        let folded = faces.filter(|(_, face)| is_folded(face)).map(|(k, _)| k);
        folded.collect::<Vec<_>>()
    };
    (1..STEPS)
        .into_par_iter()
        .flat_map_iter(folded_at)
        .collect()
}
