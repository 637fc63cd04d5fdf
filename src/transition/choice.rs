//! Choosing among matches: for each piece the one whose film has the least
//! trouble.
//!
//! No measure of two boundaries alone tells what becomes of the inside, so a
//! match is judged by its film. Each piece moves by itself, so that each is
//! chosen for itself. Candidates come in rounds: first the match at
//! the prices that were asked for, and at other prices beside it where the
//! shapes are unlike; then, as long as the best film folds, the others. The best
//! of all so far is the one with the fewest folded faces over all its steps,
//! then the fewest crossings of its outlines, then the least distortion,
//! outlines that grow jagged on the way included, then the earliest. What was
//! chosen then slides, as long as that makes it better.

use super::candidate::{Candidate, NoCandidate};
use super::conflicts::is_in_both;
use super::error::BuildError;
use super::spec::TransitionSpec;
use crate::compatible::{PolygonsError, slid};
use crate::correspondence::{MatchOptions, Matching, PieceMatch, Prepared};
use crate::progress::{Progress, Several, Span, still_wanted};
use rayon::prelude::*;

/// A match of at most this cost whose film does not fold is taken at once.
/// Two poses of a thing cost up to about 0.3, unlike things 0.4 and more.
const ALIKE: f64 = 0.34;

/// Prices of stretch that are tried for unlike shapes, after the default.
const OTHER_PRICES: [f64; 2] = [0.6, 1.2];

/// The price of inner distances of a match that is tried for unlike shapes as
/// well. It sees limbs and strokes, and with this price little else.
const INNER: f64 = 8.0;

/// What is tried where all of those fold: prices without regard to
/// thickness, which of a thick body and thin arms makes one arm the body.
const LAST_PRICES: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// How much is done once the match that was asked for has its film, those
/// beside it have theirs, and the last ones, as it is told.
const FIRST: f64 = 0.2;
const SECOND: f64 = 0.5;
const THIRD: f64 = 0.7;

/// How often a piece slides.
const SLIDES: u32 = 3;

/// Maps that distort less are left as they are: two drawings of one thing.
const FAITHFUL: f64 = 1.02;

/// What became of a piece: its best candidate, or why there is none.
pub(super) type Chosen = Result<Candidate, (PieceMatch, PolygonsError)>;

/// The best of each piece of a group of parts.
pub(super) fn best_of_group(
    prepared: &Prepared,
    group: usize,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Vec<Chosen>, BuildError> {
    let asked = &spec.options.matching;
    let begin = Span::new(progress, 0.0, FIRST);
    let mut chosen = as_asked(prepared, group, spec, &begin)?;
    let rounds = if prepared.is_crowd() {
        Vec::new()
    } else {
        rounds(asked)
    };
    let spans = [(FIRST, SECOND), (SECOND, THIRD)].map(|(a, b)| Span::new(progress, a, b));
    for (k, (round, span)) in rounds.iter().zip(&spans).enumerate() {
        let wants = |chosen: &Chosen| match chosen {
            Err(_) => true,
            Ok(best) if k == 0 => is_in_both(&best.matched) && best.matched.cost > ALIKE,
            // Folds alone: the last prices match worse, and are for want of better.
            // Tried against crossings too they take twice as long and help one
            // pair of icons of 58.
            Ok(best) => best.folds(),
        };
        let wants: Vec<bool> = chosen.iter().map(wants).collect();
        if wants.contains(&true) {
            let found = others(prepared, group, spec, round, &wants, span)?;
            found
                .into_iter()
                .for_each(|found| take_better(&mut chosen, found));
        }
    }
    let last = Span::new(progress, THIRD, 1.0);
    let shares = Several::new(&last, chosen.len());
    let settled = chosen.into_par_iter().enumerate();
    settled
        .map(|(k, chosen)| match chosen {
            Ok(best) => Ok(Ok(settled_by_sliding(best, spec, &shares.part(k))?)),
            none => Ok(none),
        })
        .collect()
}

/// The pieces of a group at the prices that were asked for.
fn as_asked(
    prepared: &Prepared,
    group: usize,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Vec<Chosen>, BuildError> {
    let prices = spec.options.matching.options();
    let pieces = prepared.matched_group(group, &prices, progress)?;
    let shares = Several::new(progress, pieces.len());
    let pieces = pieces.into_par_iter().enumerate();
    pieces
        .map(|(k, piece)| candidate(piece, spec, &shares.part(k)))
        .collect()
}

/// Takes those that are better, piece by piece, and the earlier among equals.
fn take_better(chosen: &mut [Chosen], found: Vec<Option<Candidate>>) {
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
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Chosen, BuildError> {
    match Candidate::new(piece.clone(), &spec.options, progress) {
        Ok(candidate) => Ok(Ok(candidate)),
        Err(NoCandidate::Build(error)) => Err(error),
        Err(NoCandidate::Mesh(PolygonsError::Cancelled(cancelled))) => Err(cancelled.into()),
        Err(NoCandidate::Mesh(error)) => Ok(Err((piece, error))),
    }
}

/// For each of these matches the candidates of the pieces that want one.
fn others(
    prepared: &Prepared,
    group: usize,
    spec: &TransitionSpec,
    round: &[MatchOptions],
    wants: &[bool],
    progress: &dyn Progress,
) -> Result<Vec<Vec<Option<Candidate>>>, BuildError> {
    let shares = Several::new(progress, round.len());
    let found = round.par_iter().enumerate().map(|(k, options)| {
        let share = shares.part(k);
        let [begin, rest] = [(0.0, FIRST), (FIRST, 1.0)].map(|(a, b)| Span::new(&share, a, b));
        let matched = prepared.matched_group(group, options, &begin);
        still_wanted(progress)?;
        // What cannot be had is no better: there is the first one.
        let pieces = matched.unwrap_or_default();
        let shares = Several::new(&rest, pieces.len());
        let pieces = pieces.into_par_iter().zip(wants).enumerate();
        let candidates = pieces.map(|(k, (piece, wanted))| {
            let made = wanted.then(|| Candidate::new(piece, &spec.options, &shares.part(k)).ok());
            // But a cancel is an answer.
            still_wanted(progress)?;
            Ok(made.flatten())
        });
        candidates.collect::<Result<Vec<_>, BuildError>>()
    });
    found.collect()
}

/// What was chosen, its correspondence and its map improved together as long
/// as its film is the better for it.
fn settled_by_sliding(
    mut best: Candidate,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Candidate, BuildError> {
    for round in 0..SLIDES {
        if !is_in_both(&best.matched) || best.distortion < FAITHFUL {
            break;
        }
        let share = |k: u32| f64::from(k) / f64::from(SLIDES);
        let progress = &Span::new(progress, share(round), share(round + 1));
        let options = &spec.options.triangulation;
        let places = slid(&best.matched, &best.mesh, options, progress);
        still_wanted(progress)?;
        let Some(places) = places else { break };
        let moved = Candidate::new(best.matched.moved(&places), &spec.options, progress).ok();
        still_wanted(progress)?;
        match moved {
            Some(moved) if moved.is_better_than(&best) => best = moved,
            _ => break,
        }
    }
    Ok(best)
}

/// What is tried after the match that was asked for, round by round; nothing
/// where somebody settled the price.
fn rounds(asked: &Matching) -> Vec<Vec<MatchOptions>> {
    if asked.stretch.is_some() {
        return Vec::new();
    }
    let asked = asked.options();
    let priced = |stretch: f64, thickness: f64| MatchOptions {
        stretch,
        thickness,
        ..asked.clone()
    };
    let inside = MatchOptions {
        inner: INNER,
        ..asked.clone()
    };
    let mut others = OTHER_PRICES
        .map(|price| priced(price, asked.thickness))
        .to_vec();
    others.push(inside);
    vec![others, LAST_PRICES.map(|price| priced(price, 0.0)).to_vec()]
}
