//! Removes folds from a rigid interpolation by stiffening the folded faces, as far as possible.
//!
//! This applies only to homotopies that keep orientation; motions with other homotopies are left
//! unchanged. Such a homotopy prescribes an affine map for each face at each t. A face that follows
//! its map exactly never folds; a face folds because its neighbours pull it away from its map.
//! Folded faces are therefore stiffened repeatedly, until no face folds, but at most [`MAX_ROUNDS`]
//! times. At t = 0 and t = 1, every face follows its map, so the motion stays exact there.
//!
//! The motion is sampled in [`STEPS`] steps; folds between two samples are missed. Not guaranteed:
//! that all folds are removed. Where large areas fold, stiffness only moves the fold elsewhere.

use super::error::BuildError;
use crate::geometry::orient2d;
use crate::warp::{Arap, Warp};
use crate::work::progress::{Progress, check_cancelled};
use rayon::prelude::*;

/// Number of equal steps of t into which the motion is divided to detect folds (resource limit).
const STEPS: u32 = 64;

/// Maximum number of times that folded faces are made stiffer (resource limit).
const MAX_ROUNDS: u32 = 8;
/// Factor by which the stiffness of a folded face is multiplied when the face is made stiffer
/// (heuristic).
const STIFFNESS_FACTOR: f64 = 4.0;

/// Maximum number of faces of a motion in which folds are removed (resource limit: each of the at
/// most [`MAX_ROUNDS`] repetitions takes 0.4 s per 100,000 faces).
const MAX_FACES: usize = 100_000;

/// Stiffens folded faces repeatedly and returns the motion with the fewest folds; `motion` itself
/// if none has fewer or it has more than [`MAX_FACES`] faces.
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

/// Returns the indices of the faces that are not positively oriented at some step. A face occurs
/// once for each such step.
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
