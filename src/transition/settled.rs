//! Parts that keep out of each other's way.
//!
//! Each piece has its match by itself. Parts of both designs that would then go
//! through each other are let go: what is there dies, and what it was to become
//! is born. So is a piece of which there is no mesh. That is seen with matches
//! as they were asked for, which cost little, and again with the best of each
//! piece. In the film that is left all that is born or dies gets its place and
//! its time.

use super::births::{self, lives};
use super::candidate::Candidate;
use super::choice::{best_of_group, drafts_of_group};
use super::conflicts::in_the_way;
use super::drawings::Drawings;
use super::error::BuildError;
use super::group::{Chosen, GroupOf};
use super::guarded::Unproved;
use super::holes::{HoleOf, timed};
use super::levels::Levels;
use super::mirrored;
use super::note::Note;
use super::options::{Guarding, Options, Quality};
use super::rigid::{allow, coarse};
use super::spec::TransitionSpec;
use super::steps::Steps;
use super::unfolded::unfolded;
use crate::compatible::{OutlinesError, joined};
use crate::correspondence::{Group, Prepared, RegionMatch};
use crate::progress::{Progress, Several, Span, checkpoint};
use crate::warp::{Arap, ArapOptions, Settled};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// How often pieces are let go: what was split is split anew, and may meet
/// anew.
const ROUNDS: u32 = 3;

/// How often all that is born or dies is placed anew for what the proof found: of 60 pairs
/// of icons none was proved that took more than two.
const CLOSER: usize = 3;

/// How much is done once it is known who is let go of the matches as they were
/// asked for.
const DRAFTED: f64 = 0.15;

/// How much of a round is done once the pieces have their matches.
const CHOSEN: f64 = 0.9;

/// The film of both outlines, as it is settled: not subdivided.
#[derive(Clone, Debug)]
pub(super) struct Film {
    /// The match that was kept.
    pub matched: RegionMatch,
    pub arap: Arap,
    /// Holes that one of the designs has alone.
    pub holes: Vec<HoleOf>,
    /// The pieces that one of the designs has alone and that swell.
    pub swelling: Vec<usize>,
    pub notes: Vec<Note>,
}

/// The match of both outlines that is kept, and its film, settled.
pub(super) fn best(
    spec: &TransitionSpec,
    drawings: &Drawings,
    progress: &dyn Progress,
) -> Result<Film, BuildError> {
    let designs = drawings.outlines.each_ref();
    checkpoint(progress, "matching", 0.0)?;
    let asked = &spec.options.matching;
    let mut prepared = Prepared::new(designs, &drawings.looks, asked, progress)?;
    let (mut film, pieces) = parted(&mut prepared, spec, progress)?;
    if spec.options.quality == Quality::Best {
        film.notes
            .extend(mirrored::note(spec, drawings, &pieces, progress)?);
    }
    let levels = Levels::of(&film.matched, &drawings.looks);
    let arap = unfolded(film.arap, progress)?;
    // What is held stiffer moves a little otherwise.
    let holes = timed(&film.matched.pieces, &arap, &levels, progress)?;
    kept_apart(
        Film {
            arap,
            holes,
            ..film
        },
        &levels,
        &spec.options,
        progress,
    )
}

/// A film with all that is born or dies in its place and time, in which nothing meets
/// anything, as far as that can be had.
///
/// Where the proof finds what was missed between the steps that were looked at, these
/// are looked at, too, and all is placed anew.
fn kept_apart(
    film: Film,
    levels: &Levels,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Film, BuildError> {
    let (mut steps, mut first, mut met) = (Steps::default(), None, Vec::new());
    loop {
        let placed = placed(film.clone(), (levels, &steps), options.quality, progress)?;
        let arap = unfolded(placed.arap, progress)?;
        let film = Film { arap, ..placed };
        if (options.quality, options.guard) != (Quality::Best, Guarding::Guarded) {
            return Ok(film);
        }
        let pieces = (film.matched.pieces.len(), &film.swelling[..]);
        let Some(unproved) = Unproved::of(&film.arap, pieces, levels, progress)? else {
            return Ok(film);
        };
        let births = unproved.births();
        let now = (film, unproved);
        if births.is_empty() || met.len() == CLOSER || met.last() == Some(&births) {
            // What was looked at more closely in vain stays as it was at first.
            let kept = if births.is_empty() { None } else { first };
            let (film, unproved) = kept.unwrap_or(now);
            let arap = unproved.kept_apart(progress)?;
            return Ok(Film { arap, ..film });
        }
        births.iter().for_each(|&t| steps.look_at(t));
        met.push(births);
        first.get_or_insert(now);
    }
}

/// A settled film as the options ask for it.
pub(super) fn as_options_ask(
    settled: &Arap,
    asked: &ArapOptions,
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    if settled.options() == asked {
        return Ok(settled.clone());
    }
    unfolded(settled.rebuilt(asked, progress)?, progress)
}

/// The match of each piece, once what would go through other parts is let go,
/// and the film of all.
fn parted(
    prepared: &mut Prepared,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<(Film, Vec<Candidate>), BuildError> {
    if spec.options.quality == Quality::Draft {
        return Ok(apart(prepared, spec, &as_asked, progress)?.0);
    }
    // The best of all pieces of what is let go at once was half of the work: of
    // two icons 17 s, now 7.7.
    let [drafting, choosing] =
        [(0.0, DRAFTED), (DRAFTED, 1.0)].map(|(from, to)| Span::new(progress, from, to));
    let (_, drafts) = apart(prepared, spec, &as_asked, &drafting)?;
    let best = |group: &GroupOf, progress: &dyn Progress| {
        let drafts = drafts.get(&group.prepared.groups()[group.group]);
        best_of_group(group, drafts, progress)
    };
    Ok(apart(prepared, spec, &best, &choosing)?.0)
}

/// How the pieces of a group get their matches.
type Choice<'a> = dyn Fn(&GroupOf, &dyn Progress) -> Result<Vec<Chosen>, BuildError> + Sync + 'a;

fn as_asked(group: &GroupOf, progress: &dyn Progress) -> Result<Vec<Chosen>, BuildError> {
    drafts_of_group(group, progress)
}

/// The pieces so chosen, once those are let go that would go through others,
/// with their film; and what was chosen, group by group.
fn apart(
    prepared: &mut Prepared,
    spec: &TransitionSpec,
    choice: &Choice,
    progress: &dyn Progress,
) -> Result<((Film, Vec<Candidate>), Known), BuildError> {
    let mut known = Known::new();
    let (mut round, mut mended) = (0, 0);
    loop {
        // Most films need one round, few the last.
        let done = |rounds: u32| 1.0 - 0.5_f64.powi(rounds as i32);
        let progress = &Span::new(progress, done(round), done(round + 1));
        let [choosing, filming] =
            [(0.0, CHOSEN), (CHOSEN, 1.0)].map(|(from, to)| Span::new(progress, from, to));
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
        let mesh = joined(candidates.iter().map(|best| &best.mesh));
        allow(&mesh, &spec.options.arap, progress)?;
        let coarse = coarse(&spec.options.arap);
        let arap = Arap::of_outlines(&mesh, &coarse, &lives(&matched), &filming)?;
        let levels = Levels::of(&matched, prepared.looks());
        let holes = timed(&matched.pieces, &arap, &levels, progress)?;
        let gone = in_the_way(&matched, &arap, (&holes, &levels), progress)?;
        if round == ROUNDS || !prepared.let_go(&matched, &gone, progress) {
            let film = Film {
                matched,
                arap,
                holes,
                swelling: Vec::new(),
                notes: Vec::new(),
            };
            return Ok(((film, candidates), known));
        }
        round += 1;
    }
}

/// The groups of parts whose pieces are chosen already.
type Known = BTreeMap<Group, Vec<Chosen>>;

/// The pieces of each group, but for those that are chosen already.
fn chosen(
    prepared: &Prepared,
    known: &Known,
    spec: &TransitionSpec,
    choice: &Choice,
    progress: &dyn Progress,
) -> Result<Vec<Vec<Chosen>>, BuildError> {
    let shares = Several::new(progress, prepared.groups().len());
    let groups = prepared.groups().par_iter().enumerate();
    let chosen = groups.map(|(k, group)| match known.get(group) {
        Some(known) => Ok(known.clone()),
        None => {
            let group = GroupOf {
                prepared,
                group: k,
                spec,
            };
            choice(&group, &shares.part(k))
        }
    });
    // All first: of several failures it is the first in order that is told.
    let chosen: Vec<Result<Vec<Chosen>, BuildError>> = chosen.collect();
    chosen.into_iter().collect()
}

fn match_of(groups: &[Vec<Chosen>]) -> RegionMatch {
    let piece = |chosen: &Chosen| match chosen {
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
fn broken(groups: &[Vec<Chosen>], mended: u32) -> Vec<usize> {
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
fn meshed(chosen: Vec<Chosen>) -> Result<Vec<Candidate>, BuildError> {
    let pieces = chosen.len();
    let candidates = chosen.into_iter().enumerate().map(|(piece, chosen)| {
        chosen.map_err(|(_, error)| {
            let error = OutlinesError {
                piece,
                pieces,
                error,
            };
            error.into()
        })
    });
    candidates.collect()
}

/// A film with all that is born or dies in its place and time.
fn placed(
    film: Film,
    (levels, steps): (&Levels, &Steps),
    quality: Quality,
    progress: &dyn Progress,
) -> Result<Film, BuildError> {
    let options = film.arap.options();
    let there = (&film.holes[..], levels, steps);
    let placed = births::placed(&film.matched, &film.arap, there, quality, progress)?;
    Ok(match placed {
        Some(placed) => {
            let settled = Settled {
                lives: &placed.lives,
                stiffness: film.arap.stiffness(),
            };
            Film {
                arap: Arap::settled(&placed.mesh, options, settled, progress)?,
                matched: placed.matched,
                swelling: placed.swelling,
                // They lie in none of what was moved.
                ..film
            }
        }
        None => film,
    })
}
