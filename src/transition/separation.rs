//! Parts that keep out of each other's way.
//!
//! Each piece has its match by itself. Parts of both designs that would then go
//! through each other are let go: what is there dies, and what it was to become
//! is born. So is a piece of which there is no mesh. That is seen with matches
//! as they were asked for, which cost little, and again with the best of each
//! piece. Between the two, large parts that are alone are shared out to their
//! neighbours, where that fits better than that they come and go.

use super::arap_build::{check_size, unsubdivided};
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
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, still_wanted};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// How often pieces are let go: what was split is split anew, and may meet
/// anew.
const ROUNDS: u32 = 3;

/// How much is done once it is known who is let go of the matches as they were
/// asked for, and once it is known what is shared out.
const DRAFTED: f64 = 0.1;
const SHARED: f64 = 0.2;

/// How much of a round is done once the pieces have their matches.
const CHOSEN: f64 = 0.9;

/// A part that comes or goes fits as badly as one of its size that is distorted so much. With
/// 100, three of 120 pairs of icons move otherwise. Were only counted what is alone, a word
/// would be cut from a sign, and the worst tenth of 60 pairs distorted by 27, not 23.
const ALONE: f64 = 30.0;

/// Sharing out is worth it where less is alone by this, as a share of both designs. Half a large part: where one is let go for another, nothing is won, and
/// of two words an m would become an e, upside down.
const SAVED: f64 = 0.05;

/// The matches of all pieces, of which none of both designs meet, and their film.
pub(super) struct Separation {
    pub(super) matched: RegionMatch,
    pub(super) arap: Arap,
    pub(super) pieces: Vec<MatchCandidate>,
    known: ChosenGroups,
}

impl Separation {
    /// What is alone, as a share of both designs.
    fn alone(&self) -> f64 {
        let pieces = self.matched.pieces.iter().zip(piece_weights(&self.matched));
        let alone = pieces.filter(|(piece, _)| !piece.is_in_both());
        alone.map(|(_, worth)| worth).sum()
    }

    /// The mean of the pieces' misfits and of [`ALONE`], in logarithms, each counting as
    /// much as its share of the designs.
    fn misfit(&self) -> f64 {
        let of = |piece: &MatchCandidate| match piece.matched.is_in_both() {
            true => piece.misfit(),
            false => ALONE,
        };
        let pieces = self.pieces.iter().zip(piece_weights(&self.matched));
        pieces.map(|(piece, worth)| worth * of(piece).ln()).sum()
    }
}

/// The match of each piece, once what would go through other parts is let go,
/// and the film of all.
pub(super) fn separate(
    prepared: &mut MatchPlan,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Separation, BuildError> {
    if spec.options.quality == BuildQuality::Draft {
        return apart(prepared, spec, &as_asked, progress);
    }
    // The best of all pieces of what is let go at once was half of the work: of
    // two icons 17 s, now 7.7.
    let [drafting, sharing, choosing] = [(0.0, DRAFTED), (DRAFTED, SHARED), (SHARED, 1.0)]
        .map(|(from, to)| ProgressSpan::new(progress, from, to));
    let mut drafts = apart(prepared, spec, &as_asked, &drafting)?;
    if let Some(mut other) = prepared.shared_out(&sharing) {
        // What cannot be had is no better: there is a film without it.
        let shared = apart(&mut other, spec, &as_asked, &sharing).ok();
        still_wanted(&sharing)?;
        let is_better = |shared: &Separation| {
            drafts.alone() - shared.alone() > SAVED && shared.misfit() < drafts.misfit()
        };
        if let Some(shared) = shared.filter(is_better) {
            (*prepared, drafts) = (other, shared);
        }
    }
    let best = |group: &GroupSearch, progress: &dyn Progress| {
        let drafts = drafts.known.get(&group.prepared.groups()[group.group]);
        best_of_group(group, drafts, progress)
    };
    apart(prepared, spec, &best, &choosing)
}

/// How the pieces of a group get their matches.
type PieceChooser<'a> =
    dyn Fn(&GroupSearch, &dyn Progress) -> Result<Vec<PieceResult>, BuildError> + Sync + 'a;

fn as_asked(group: &GroupSearch, progress: &dyn Progress) -> Result<Vec<PieceResult>, BuildError> {
    drafts_of_group(group, progress)
}

/// The pieces so chosen, once those are let go that would go through others,
/// with their film.
fn apart(
    prepared: &mut MatchPlan,
    spec: &TransitionSpec,
    choice: &PieceChooser,
    progress: &dyn Progress,
) -> Result<Separation, BuildError> {
    let mut known = ChosenGroups::new();
    let (mut round, mut mended) = (0, 0);
    loop {
        // Most films need one round, few the last.
        let done = |rounds: u32| 1.0 - 0.5_f64.powi(rounds as i32);
        let progress = &ProgressSpan::new(progress, done(round), done(round + 1));
        let [choosing, filming] =
            [(0.0, CHOSEN), (CHOSEN, 1.0)].map(|(from, to)| ProgressSpan::new(progress, from, to));
        let groups = chosen(prepared, &known, spec, choice, &choosing)?;
        let matched = match_of(&groups);
        known = prepared
            .groups()
            .iter()
            .cloned()
            .zip(groups.clone())
            .collect();
        if prepared.let_go(&matched, &broken(&groups, mended), progress) {
            mended += 1;
            continue;
        }
        let candidates = meshed(groups.concat())?;
        let mesh = merged_meshes(candidates.iter().map(|best| &best.mesh));
        check_size(&mesh, &spec.options.arap, progress)?;
        let coarse = unsubdivided(&spec.options.arap);
        let arap = Arap::of_outlines(&mesh, &coarse, &lives(&matched), &filming)?;
        let levels = PieceLayers::of(&matched, prepared.looks());
        let holes = timed(&matched.pieces, &arap, &levels, progress)?;
        let gone = pieces_to_release(&matched, &arap, (&holes, &levels), progress)?;
        if round == ROUNDS || !prepared.let_go(&matched, &gone, progress) {
            return Ok(Separation {
                matched,
                arap,
                pieces: candidates,
                known,
            });
        }
        round += 1;
    }
}

/// The groups of parts whose pieces are chosen already.
type ChosenGroups = BTreeMap<PartGroup, Vec<PieceResult>>;

/// The pieces of each group, but for those that are chosen already.
fn chosen(
    prepared: &MatchPlan,
    known: &ChosenGroups,
    spec: &TransitionSpec,
    choice: &PieceChooser,
    progress: &dyn Progress,
) -> Result<Vec<Vec<PieceResult>>, BuildError> {
    let shares = ProgressShares::new(progress, prepared.groups().len());
    let groups = prepared.groups().par_iter().enumerate();
    let chosen = groups.map(|(k, group)| match known.get(group) {
        Some(known) => Ok(known.clone()),
        None => {
            let group = GroupSearch {
                prepared,
                group: k,
                spec,
            };
            choice(&group, &shares.part(k))
        }
    });
    // All first: of several failures it is the first in order that is told.
    let chosen: Vec<Result<Vec<PieceResult>, BuildError>> = chosen.collect();
    chosen.into_iter().collect()
}

fn match_of(groups: &[Vec<PieceResult>]) -> RegionMatch {
    let piece = |chosen: &PieceResult| match chosen {
        Ok(best) => best.matched.clone(),
        Err((piece, _)) => piece.clone(),
    };
    RegionMatch {
        pieces: groups.iter().flatten().map(piece).collect(),
    }
}

/// The pieces to let go because there is no mesh of them; where that was done
/// before, with all that they were split from: what is split anew may break
/// anew.
fn broken(groups: &[Vec<PieceResult>], mended: u32) -> Vec<usize> {
    let mut first = 0;
    let mut broken = Vec::new();
    for group in groups {
        let is_broken = group.iter().any(Result::is_err);
        let is_let_go = |k: &usize| group[*k].is_err() || (is_broken && mended > 0);
        broken.extend((0..group.len()).filter(is_let_go).map(|k| first + k));
        first += group.len();
    }
    broken
}

/// All pieces, or what is wrong with the first that has no mesh.
fn meshed(chosen: Vec<PieceResult>) -> Result<Vec<MatchCandidate>, BuildError> {
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
