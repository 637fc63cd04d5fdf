//! Matches the pieces of a group, that is, of parts that are matched together, with several
//! variants of the match options, and selects the best match of each piece.

use super::candidate::{CandidateError, MatchCandidate};
use crate::compatible::PieceMeshError;
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchPlan, PieceMatch};
use crate::transition::error::BuildError;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, check_cancelled};
use rayon::prelude::*;

/// Share of the work on one variant of the match options, in [0, 1], that is done once the pieces
/// are matched with it (heuristic).
const MATCH_PROGRESS: f64 = 0.2;

/// The result for a piece: its best match, or a match that cannot be triangulated and the reason.
pub(in crate::transition) type PieceResult = Result<MatchCandidate, (PieceMatch, PieceMeshError)>;

/// Match options and treatment of unmatched holes with which the pieces of a group of parts are
/// matched.
pub(in crate::transition) struct MatchVariant {
    pub(in crate::transition) options: MatchOptions,
    /// Treatment of unmatched holes.
    pub(in crate::transition) holes: HolePolicy,
}

/// Returns the best match of the piece so far, or the match that cannot be triangulated.
pub(in crate::transition) fn piece_of_result(chosen: &PieceResult) -> &PieceMatch {
    match chosen {
        Ok(best) => &best.matched,
        Err((piece, _)) => piece,
    }
}

/// A group of parts whose pieces are being matched: one part with one, one with several, or a
/// single unmatched part.
pub(in crate::transition) struct GroupSearch<'a> {
    pub(in crate::transition) plan: &'a MatchPlan<'a>,
    /// Index of the group in `plan`.
    pub(in crate::transition) index: usize,
    pub(in crate::transition) spec: &'a TransitionSpec,
}

impl GroupSearch<'_> {
    /// Returns how unmatched holes are treated at the start of the search: as the user has
    /// requested. If the user has left the choice to the program, they are transient, that is, they
    /// appear or disappear without bending anything.
    pub(in crate::transition) fn initial_hole_policy(&self) -> HolePolicy {
        HolePolicy::Paired(match self.spec.options.matching.holes {
            HoleRule::Auto => HoleRule::Transient,
            rule => rule,
        })
    }

    /// Matches the pieces with the requested match options.
    ///
    /// # Errors
    /// If the group cannot be matched, the motion of a match cannot be solved, or the work is
    /// cancelled.
    pub(in crate::transition) fn requested_pieces(
        &self,
        progress: &dyn Progress,
    ) -> Result<Vec<PieceResult>, BuildError> {
        let (costs, holes) = (
            self.spec.options.matching.options(),
            self.initial_hole_policy(),
        );
        let pieces = self.plan.match_group(self.index, &costs, holes, progress)?;
        let shares = ProgressShares::new(progress, pieces.len());
        let pieces = pieces.into_par_iter().enumerate();
        pieces
            .map(|(k, piece)| candidate(piece, holes, self.spec, &shares.part(k)))
            .collect()
    }

    /// Tries several variants of the match options for the `selected` pieces, and replaces their
    /// matches in `chosen` by better ones.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub(in crate::transition) fn try_variants(
        &self,
        chosen: &mut [PieceResult],
        variants: &[MatchVariant],
        selected: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        if selected.contains(&true) {
            let candidates = self.candidates_of_variants(variants, selected, progress)?;
            candidates
                .into_iter()
                .for_each(|candidates| take_better(chosen, candidates));
        }
        Ok(())
    }

    /// For each variant of the match options, returns the candidate matches of all pieces; `None`
    /// for pieces that are not `selected` or cannot be triangulated or solved.
    ///
    /// # Errors
    /// If the work is cancelled.
    fn candidates_of_variants(
        &self,
        variants: &[MatchVariant],
        selected: &[bool],
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<Option<MatchCandidate>>>, BuildError> {
        let shares = ProgressShares::new(progress, variants.len());
        let candidates_by_variant = variants.par_iter().enumerate().map(|(k, variant)| {
            let share = shares.part(k);
            let [matching, rating] = [(0.0, MATCH_PROGRESS), (MATCH_PROGRESS, 1.0)]
                .map(|(a, b)| ProgressSpan::new(&share, a, b));
            let matched =
                self.plan
                    .match_group(self.index, &variant.options, variant.holes, &matching);
            check_cancelled(progress)?;
            // A variant that cannot be matched is skipped, since each piece has a result already.
            let pieces = matched.unwrap_or_default();
            let shares = ProgressShares::new(&rating, pieces.len());
            let pieces = pieces.into_par_iter().zip(selected).enumerate();
            let candidates = pieces.map(|(k, (piece, is_selected))| {
                let new = || {
                    MatchCandidate::new(piece, variant.holes, &self.spec.options, &shares.part(k))
                        .ok()
                };
                let candidate = is_selected.then(new);
                // A candidate match that failed is skipped, but a cancellation must end the work.
                check_cancelled(progress)?;
                Ok(candidate.flatten())
            });
            candidates.collect::<Result<Vec<_>, BuildError>>()
        });
        candidates_by_variant.collect()
    }
}

/// Replaces the match of each piece by the candidate match if that is better; if both are equal,
/// the previous match stays.
pub(in crate::transition) fn take_better(
    chosen: &mut [PieceResult],
    candidates: Vec<Option<MatchCandidate>>,
) {
    for (chosen, candidate) in chosen.iter_mut().zip(candidates) {
        let is_better = |candidate: &MatchCandidate| match &*chosen {
            Ok(best) => candidate.is_better_than(best),
            Err(_) => true,
        };
        if let Some(candidate) = candidate.filter(is_better) {
            *chosen = Ok(candidate);
        }
    }
}

/// Triangulates a matched piece and rates its motion. A piece that cannot be triangulated is a
/// result, not an error.
///
/// # Errors
/// If the motion cannot be solved or the work is cancelled.
fn candidate(
    piece: PieceMatch,
    holes: HolePolicy,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<PieceResult, BuildError> {
    match MatchCandidate::new(piece.clone(), holes, &spec.options, progress) {
        Ok(candidate) => Ok(Ok(candidate)),
        Err(CandidateError::Build(error)) => Err(error),
        Err(CandidateError::Mesh(PieceMeshError::Cancelled(cancelled))) => Err(cancelled.into()),
        Err(CandidateError::Mesh(error)) => Ok(Err((piece, error))),
    }
}
