//! The pieces of a group of parts, matched in several ways: for each piece the
//! best candidate so far.

use super::candidate::{Candidate, NoCandidate};
use super::error::BuildError;
use super::spec::TransitionSpec;
use crate::compatible::PolygonsError;
use crate::correspondence::{HoleRule, Holes, MatchOptions, PieceMatch, Prepared};
use crate::progress::{Progress, Several, Span, still_wanted};
use rayon::prelude::*;

/// How much of a way is done once the pieces are matched, as it is told.
const MATCHED: f64 = 0.2;

/// What became of a piece: its best candidate, or why there is none.
pub(super) type Chosen = Result<Candidate, (PieceMatch, PolygonsError)>;

/// One way to match the pieces of a group.
pub(super) struct Way {
    pub(super) options: MatchOptions,
    pub(super) holes: Holes,
}

/// The piece, as it is matched best so far.
pub(super) fn piece(chosen: &Chosen) -> &PieceMatch {
    match chosen {
        Ok(best) => &best.matched,
        Err((piece, _)) => piece,
    }
}

/// A group of parts that is being matched.
pub(super) struct GroupOf<'a> {
    pub(super) prepared: &'a Prepared<'a>,
    /// Its number among the groups.
    pub(super) group: usize,
    pub(super) spec: &'a TransitionSpec,
}

impl GroupOf<'_> {
    /// How holes without a partner are treated at first: as was asked for, or
    /// so that they bend nothing.
    pub(super) fn first_holes(&self) -> Holes {
        Holes::By(match self.spec.options.matching.holes {
            HoleRule::Auto => HoleRule::Alone,
            rule => rule,
        })
    }

    /// The pieces at the prices that were asked for.
    pub(super) fn as_asked(&self, progress: &dyn Progress) -> Result<Vec<Chosen>, BuildError> {
        let (prices, holes) = (self.spec.options.matching.options(), self.first_holes());
        let pieces = self
            .prepared
            .matched_group(self.group, &prices, holes, progress)?;
        let shares = Several::new(progress, pieces.len());
        let pieces = pieces.into_par_iter().enumerate();
        pieces
            .map(|(k, piece)| candidate(piece, holes, self.spec, &shares.part(k)))
            .collect()
    }

    /// Tries several ways to match the pieces that want it, and takes those that
    /// are better.
    pub(super) fn try_ways(
        &self,
        chosen: &mut [Chosen],
        ways: &[Way],
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
        ways: &[Way],
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<Option<Candidate>>>, BuildError> {
        let shares = Several::new(progress, ways.len());
        let found = ways.par_iter().enumerate().map(|(k, way)| {
            let share = shares.part(k);
            let [begin, rest] =
                [(0.0, MATCHED), (MATCHED, 1.0)].map(|(a, b)| Span::new(&share, a, b));
            let matched = self
                .prepared
                .matched_group(self.group, &way.options, way.holes, &begin);
            still_wanted(progress)?;
            // What cannot be had is no better: there is the first one.
            let pieces = matched.unwrap_or_default();
            let shares = Several::new(&rest, pieces.len());
            let pieces = pieces.into_par_iter().zip(wants).enumerate();
            let candidates = pieces.map(|(k, (piece, wanted))| {
                let new =
                    || Candidate::new(piece, way.holes, &self.spec.options, &shares.part(k)).ok();
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
pub(super) fn take_better(chosen: &mut [Chosen], found: Vec<Option<Candidate>>) {
    for (chosen, found) in chosen.iter_mut().zip(found) {
        let is_better = |found: &Candidate| match &*chosen {
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
    holes: Holes,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Chosen, BuildError> {
    match Candidate::new(piece.clone(), holes, &spec.options, progress) {
        Ok(candidate) => Ok(Ok(candidate)),
        Err(NoCandidate::Build(error)) => Err(error),
        Err(NoCandidate::Mesh(PolygonsError::Cancelled(cancelled))) => Err(cancelled.into()),
        Err(NoCandidate::Mesh(error)) => Ok(Err((piece, error))),
    }
}
