//! Slides corresponding points of the best matches along the outlines, and chooses the better of
//! the two results of the search.
//!
//! Sliding is repeated as long as it improves the motion, at most [`MAX_SLIDES`] times.

use super::candidate::MatchCandidate;
use super::group::{PieceResult, take_better};
use crate::compatible::slide_outlines;
use crate::transition::error::BuildError;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, check_cancelled};
use rayon::prelude::*;

/// Maximum number of times that the correspondence of a piece is slid (resource limit).
const MAX_SLIDES: u32 = 3;

/// Distortion below which a match is not improved further. Two drawings of the same shape have a
/// distortion below this (heuristic).
pub(super) const LOW_DISTORTION: f64 = 1.02;

/// For each piece, slides the corresponding points of its match in `paired` and, if there is one,
/// of its match in `unpaired`, in which no holes are matched. Returns the better of the two.
/// `unpaired` has one entry per piece or is empty.
///
/// If `holes_touch`, holes stay matched as long as nothing has to fold or cross. The gap between
/// touching holes has no width in one design, so the distortion of its faces has no meaning.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn slide_and_choose(
    paired: Vec<PieceResult>,
    mut unpaired: Vec<Option<MatchCandidate>>,
    holes_touch: bool,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    unpaired.resize_with(paired.len(), || None);
    let shares = ProgressShares::new(progress, paired.len());
    let pieces = paired.into_par_iter().zip(unpaired).enumerate();
    let chosen = pieces.map(|(k, (paired, unpaired))| {
        let share = shares.part(k);
        let Some(unpaired) = unpaired else {
            return slide_piece(paired, spec, &share);
        };
        let [first, second] =
            [(0.0, 0.5), (0.5, 1.0)].map(|(from, to)| ProgressSpan::new(&share, from, to));
        let mut best = slide_piece(paired, spec, &first)?;
        if holes_touch
            && let Ok(best) = &best
            && best.can_be_sound(&spec.options, &second)?
        {
            return Ok(Ok(best.clone()));
        }
        // The two matches are compared only after sliding, because sliding can repair a match of
        // holes that folds, as between the letters D and P.
        let unpaired = slide_while_better(unpaired, spec, &second)?;
        take_better(std::slice::from_mut(&mut best), vec![Some(unpaired)]);
        Ok(best)
    });
    chosen.collect()
}

/// Slides the corresponding points of the match of a piece. Without a triangulation, returns
/// `result` unchanged.
///
/// # Errors
/// If the work is cancelled.
fn slide_piece(
    result: PieceResult,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<PieceResult, BuildError> {
    match result {
        Ok(best) => Ok(Ok(slide_while_better(best, spec, progress)?)),
        untriangulated => Ok(untriangulated),
    }
}

/// Slides the corresponding points of a match along the outlines as long as that improves its
/// motion.
///
/// # Errors
/// If the work is cancelled.
fn slide_while_better(
    mut best: MatchCandidate,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<MatchCandidate, BuildError> {
    for round in 0..MAX_SLIDES {
        if !best.matched.is_matched() || best.distortion < LOW_DISTORTION {
            break;
        }
        let fraction_after = |k: u32| f64::from(k) / f64::from(MAX_SLIDES);
        let progress =
            &ProgressSpan::new(progress, fraction_after(round), fraction_after(round + 1));
        let options = &spec.options.triangulation;
        let places = slide_outlines(&best.matched, &best.mesh, options, progress);
        check_cancelled(progress)?;
        let Some(places) = places else { break };
        let slid = best.matched.with_ring_places(&places);
        let slid = MatchCandidate::new(slid, best.holes, &spec.options, progress).ok();
        check_cancelled(progress)?;
        match slid {
            Some(slid) if slid.is_better_than(&best) => best = slid,
            _ => break,
        }
    }
    Ok(best)
}
