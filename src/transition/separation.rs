//! Matches the parts of two designs such that, as far as possible, matched parts do not pass
//! through each other.
//!
//! A piece is a pair of matched parts, a portion of a split part, or an unmatched part. Each piece
//! is matched on its own. If matched pieces then collide, some of them are unpaired: the source
//! part disappears and the target part appears. Pieces that cannot be triangulated are unpaired
//! too. Collisions are first resolved with draft matches, which are cheap, and then again with the
//! best match of each piece. In between, large unmatched parts are assigned to neighbouring groups
//! of parts, if this causes less misfit than letting them appear or disappear.

use super::arap_build::{check_size, without_subdivision};
use super::collisions::{piece_weights, pieces_to_release};
use super::error::BuildError;
use super::options::BuildQuality;
use super::search::attempts::{best_of_group, drafts_of_group};
use super::search::candidate::MatchCandidate;
use super::search::group::{GroupSearch, PieceResult};
use super::spec::TransitionSpec;
use super::transients::holes::timed;
use super::transients::layers::PieceLayers;
use super::transients::placement::lives;
use crate::compatible::{OutlineMeshError, merged_meshes};
use crate::correspondence::{MatchPlan, PartGroup, RegionMatch};
use crate::warp::Arap;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, check_cancelled};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Maximum number of times that colliding pieces are unpaired. Once may not suffice: if one of the
/// pieces of a split part is unpaired, the part is split again among the others, which can cause
/// new collisions (resource limit).
const MAX_ROUNDS: u32 = 3;

/// Progress reported once the collisions of the draft matches are resolved, in [0, 1] (heuristic).
const DRAFT_PROGRESS: f64 = 0.1;
/// Progress reported once unmatched parts are assigned to neighbouring groups of parts, in [0, 1]
/// (heuristic).
const JOIN_PROGRESS: f64 = 0.2;

/// Share of the work of one pass of [`unpair_until_separate`] that is done once the pieces are
/// matched, before their motion is solved, in [0, 1] (heuristic).
const MATCH_PROGRESS: f64 = 0.9;

/// Misfit assumed for an unmatched piece in the mean misfit of all pieces (heuristic).
const UNMATCHED_DISTORTION: f64 = 30.0;

/// Assigning unmatched parts to neighbouring groups of parts is accepted only if it reduces the
/// unmatched share of the designs' area by more than this (heuristic: about half of the area of a
/// large part).
const MIN_SAVING: f64 = 0.05;

/// The matches of all pieces, with collisions resolved as far as possible, and their motion.
pub(super) struct Separation {
    pub(super) matched: RegionMatch,
    pub(super) arap: Arap,
    /// All pieces with their meshes, including the unmatched ones; in the order of `matched`.
    pub(super) pieces: Vec<MatchCandidate>,
    /// The matched pieces of each group of parts. The search for the best matches starts with them.
    groups: ChosenGroups,
}

impl Separation {
    /// Returns the share of the designs' area that is unmatched, from 0 to 1.
    fn unmatched_share(&self) -> f64 {
        let pieces = self.matched.pieces.iter().zip(piece_weights(&self.matched));
        let unmatched = pieces.filter(|(piece, _)| !piece.is_matched());
        unmatched.map(|(_, weight)| weight).sum()
    }

    /// Returns the mean of the logarithms of the pieces' misfits, weighted by the pieces' share of
    /// the area of the designs. An unmatched piece has the misfit [`UNMATCHED_DISTORTION`].
    fn mean_misfit(&self) -> f64 {
        let misfit = |piece: &MatchCandidate| match piece.matched.is_matched() {
            true => piece.misfit(),
            false => UNMATCHED_DISTORTION,
        };
        let pieces = self.pieces.iter().zip(piece_weights(&self.matched));
        pieces
            .map(|(piece, weight)| weight * misfit(piece).ln())
            .sum()
    }
}

/// Matches each piece and resolves collisions.
///
/// # Errors
/// If a piece cannot be matched at all, the motion cannot be solved, or the work is cancelled.
pub(super) fn separate(
    prepared: &mut MatchPlan,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Separation, BuildError> {
    if spec.options.quality == BuildQuality::Draft {
        return unpair_until_separate(prepared, spec, &requested_matches, progress);
    }
    // Pieces are first unpaired with cheap draft matches, which saves half of the search for the
    // best matches.
    let [drafting, joining, searching] = [
        (0.0, DRAFT_PROGRESS),
        (DRAFT_PROGRESS, JOIN_PROGRESS),
        (JOIN_PROGRESS, 1.0),
    ]
    .map(|(from, to)| ProgressSpan::new(progress, from, to));
    let mut drafts = unpair_until_separate(prepared, spec, &requested_matches, &drafting)?;
    if let Some(mut joined) = prepared.with_large_parts_assigned(&joining) {
        // A failed attempt is ignored, since a result exists already.
        let candidate = unpair_until_separate(&mut joined, spec, &requested_matches, &joining).ok();
        check_cancelled(&joining)?;
        let is_better = |candidate: &Separation| {
            drafts.unmatched_share() - candidate.unmatched_share() > MIN_SAVING
                && candidate.mean_misfit() < drafts.mean_misfit()
        };
        if let Some(candidate) = candidate.filter(is_better) {
            (*prepared, drafts) = (joined, candidate);
        }
    }
    let best = |group: &GroupSearch, progress: &dyn Progress| {
        let drafts = drafts.groups.get(&group.plan.groups()[group.index]);
        best_of_group(group, drafts, progress)
    };
    unpair_until_separate(prepared, spec, &best, &searching)
}

/// Function that chooses the match of each piece of a group of parts.
type PieceChooser<'a> =
    dyn Fn(&GroupSearch, &dyn Progress) -> Result<Vec<PieceResult>, BuildError> + Sync + 'a;

/// Returns the draft match of each piece; see [`drafts_of_group`].
fn requested_matches(
    group: &GroupSearch,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    drafts_of_group(group, progress)
}

/// Matches the pieces of each group of parts with the function `choice`. Then finds the matched
/// pieces that collide during the motion, unpairs some of them, and matches the changed groups
/// again. Ends when no piece is unpaired any more, or when pieces have been unpaired [`MAX_ROUNDS`]
/// times because of collisions. Pieces that cannot be triangulated are unpaired too; this is not
/// counted.
///
/// # Errors
/// As [`separate`].
fn unpair_until_separate(
    prepared: &mut MatchPlan,
    spec: &TransitionSpec,
    choice: &PieceChooser,
    progress: &dyn Progress,
) -> Result<Separation, BuildError> {
    let mut chosen_groups = ChosenGroups::new();
    let (mut round, mut repairs) = (0, 0);
    loop {
        // The number of rounds is not known in advance; usually there is only one. Each round gets
        // half of the progress that remains, so that progress never reaches its end too early.
        let done = |rounds: u32| 1.0 - 0.5_f64.powi(rounds as i32);
        let progress = &ProgressSpan::new(progress, done(round), done(round + 1));
        let [matching, solving] = [(0.0, MATCH_PROGRESS), (MATCH_PROGRESS, 1.0)]
            .map(|(from, to)| ProgressSpan::new(progress, from, to));
        let groups = choose_pieces(prepared, &chosen_groups, spec, choice, &matching)?;
        let matched = combined_match(&groups);
        chosen_groups = prepared
            .groups()
            .iter()
            .cloned()
            .zip(groups.clone())
            .collect();
        if prepared.unpair(&matched, &failed_pieces(&groups, repairs), progress) {
            repairs += 1;
            continue;
        }
        let candidates = require_meshes(groups.concat())?;
        let mesh = merged_meshes(candidates.iter().map(|best| &best.mesh));
        check_size(&mesh, &spec.options.arap, progress)?;
        let coarse = without_subdivision(&spec.options.arap);
        let arap = Arap::of_outlines(&mesh, &coarse, &lives(&matched), &solving)?;
        let layers = PieceLayers::of(&matched, prepared.appearances());
        let holes = timed(&matched.pieces, &arap, &layers, progress)?;
        let unpaired = pieces_to_release(&matched, &arap, &holes, &layers, progress)?;
        if round == MAX_ROUNDS || !prepared.unpair(&matched, &unpaired, progress) {
            return Ok(Separation {
                matched,
                arap,
                pieces: candidates,
                groups: chosen_groups,
            });
        }
        round += 1;
    }
}

/// The pieces of each group of parts that has been matched.
type ChosenGroups = BTreeMap<PartGroup, Vec<PieceResult>>;

/// Returns the matched pieces of each group of parts: those in `chosen_groups`, or else those that
/// `choice` returns.
///
/// # Errors
/// The first error in the order of the groups.
fn choose_pieces(
    prepared: &MatchPlan,
    chosen_groups: &ChosenGroups,
    spec: &TransitionSpec,
    choice: &PieceChooser,
    progress: &dyn Progress,
) -> Result<Vec<Vec<PieceResult>>, BuildError> {
    let shares = ProgressShares::new(progress, prepared.groups().len());
    let groups = prepared.groups().par_iter().enumerate();
    let chosen = groups.map(|(k, group)| match chosen_groups.get(group) {
        Some(pieces) => Ok(pieces.clone()),
        None => {
            let group = GroupSearch {
                plan: prepared,
                index: k,
                spec,
            };
            choice(&group, &shares.part(k))
        }
    });
    // All results are collected first, so that the reported error does not depend on the order of
    // threads.
    let chosen: Vec<Result<Vec<PieceResult>, BuildError>> = chosen.collect();
    chosen.into_iter().collect()
}

/// Combines the matches of the pieces of all groups into one match of the designs.
fn combined_match(groups: &[Vec<PieceResult>]) -> RegionMatch {
    let piece_of = |chosen: &PieceResult| match chosen {
        Ok(best) => best.matched.clone(),
        Err((piece, _)) => piece.clone(),
    };
    RegionMatch {
        pieces: groups.iter().flatten().map(piece_of).collect(),
    }
}

/// Returns the indices of the pieces to unpair because they cannot be triangulated.
///
/// `repairs` is the number of times that pieces have been unpaired for this reason. If it is not 0,
/// all pieces of a group with such a piece are unpaired, because the parts of the group may fail
/// again when they are grouped anew.
fn failed_pieces(groups: &[Vec<PieceResult>], repairs: u32) -> Vec<usize> {
    let mut first_piece = 0;
    let mut failing = Vec::new();
    for group in groups {
        let has_failed = group.iter().any(Result::is_err);
        let is_released = |k: &usize| group[*k].is_err() || (has_failed && repairs > 0);
        failing.extend(
            (0..group.len())
                .filter(is_released)
                .map(|k| first_piece + k),
        );
        first_piece += group.len();
    }
    failing
}

/// Returns all pieces, or the error of the first one that could not be triangulated.
fn require_meshes(chosen: Vec<PieceResult>) -> Result<Vec<MatchCandidate>, BuildError> {
    let pieces = chosen.len();
    let candidates = chosen.into_iter().enumerate().map(|(piece, chosen)| {
        chosen.map_err(|(_, error)| {
            let error = OutlineMeshError {
                piece,
                pieces,
                error,
            };
            error.into()
        })
    });
    candidates.collect()
}
