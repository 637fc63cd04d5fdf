//! The pieces of a group of parts, matched in several ways: for each piece the
//! best candidate so far.

use super::candidate::{CandidateError, MatchCandidate};
use crate::compatible::PieceMeshError;
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchPlan, PieceMatch};
use crate::transition::error::BuildError;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, still_wanted};
use rayon::prelude::*;

/// How much of a way is done once the pieces are matched, as it is told.
const MATCHED: f64 = 0.2;

/// What became of a piece: its best candidate, or why there is none.
pub(in crate::transition) type PieceResult = Result<MatchCandidate, (PieceMatch, PieceMeshError)>;

/// One way to match the pieces of a group.
pub(in crate::transition) struct MatchVariant {
    pub(in crate::transition) options: MatchOptions,
    pub(in crate::transition) holes: HolePolicy,
}

/// The piece, as it is matched best so far.
pub(in crate::transition) fn piece(chosen: &PieceResult) -> &PieceMatch {
    match chosen {
        Ok(best) => &best.matched,
        Err((piece, _)) => piece,
    }
}

/// A group of parts that is being matched.
pub(in crate::transition) struct GroupSearch<'a> {
    pub(in crate::transition) prepared: &'a MatchPlan<'a>,
    /// Its number among the groups.
    pub(in crate::transition) group: usize,
    pub(in crate::transition) spec: &'a TransitionSpec,
}

impl GroupSearch<'_> {
    /// How holes without a partner are treated at first: as was asked for, or
    /// so that they bend nothing.
    pub(in crate::transition) fn first_holes(&self) -> HolePolicy {
        HolePolicy::By(match self.spec.options.matching.holes {
            HoleRule::Auto => HoleRule::Alone,
            rule => rule,
        })
    }

    /// The pieces at the prices that were asked for.
    pub(in crate::transition) fn as_asked(
        &self,
        progress: &dyn Progress,
    ) -> Result<Vec<PieceResult>, BuildError> {
        let (prices, holes) = (self.spec.options.matching.options(), self.first_holes());
        let pieces = self
            .prepared
            .matched_group(self.group, &prices, holes, progress)?;
        let shares = ProgressShares::new(progress, pieces.len());
        let pieces = pieces.into_par_iter().enumerate();
        pieces
            .map(|(k, piece)| candidate(piece, holes, self.spec, &shares.part(k)))
            .collect()
    }

    /// Tries several ways to match the pieces that want it, and takes those that
    /// are better.
    pub(in crate::transition) fn try_ways(
        &self,
        chosen: &mut [PieceResult],
        ways: &[MatchVariant],
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        if wants.contains(&true) {
            let found = self.others(ways, wants, progress)?;
            found
                .into_iter()
                .for_each(|found| take_better(chosen, found));
        }
        Ok(())
    }

    /// For each of these ways the candidates of the pieces that want one.
    fn others(
        &self,
        ways: &[MatchVariant],
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<Option<MatchCandidate>>>, BuildError> {
        let shares = ProgressShares::new(progress, ways.len());
        let found = ways.par_iter().enumerate().map(|(k, way)| {
            let share = shares.part(k);
            let [begin, rest] =
                [(0.0, MATCHED), (MATCHED, 1.0)].map(|(a, b)| ProgressSpan::new(&share, a, b));
            let matched = self
                .prepared
                .matched_group(self.group, &way.options, way.holes, &begin);
            still_wanted(progress)?;
            // What cannot be had is no better: there is the first one.
            let pieces = matched.unwrap_or_default();
            let shares = ProgressShares::new(&rest, pieces.len());
            let pieces = pieces.into_par_iter().zip(wants).enumerate();
            let candidates = pieces.map(|(k, (piece, wanted))| {
                let new = || {
                    MatchCandidate::new(piece, way.holes, &self.spec.options, &shares.part(k)).ok()
                };
                let made = wanted.then(new);
                // But a cancel is an answer.
                still_wanted(progress)?;
                Ok(made.flatten())
            });
            candidates.collect::<Result<Vec<_>, BuildError>>()
        });
        found.collect()
    }
}

/// Takes those that are better, piece by piece, and the earlier among equals.
pub(in crate::transition) fn take_better(
    chosen: &mut [PieceResult],
    found: Vec<Option<MatchCandidate>>,
) {
    for (chosen, found) in chosen.iter_mut().zip(found) {
        let is_better = |found: &MatchCandidate| match &*chosen {
            Ok(best) => found.is_better_than(best),
            Err(_) => true,
        };
        if let Some(found) = found.filter(is_better) {
            *chosen = Ok(found);
        }
    }
}

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
