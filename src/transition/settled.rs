//! The film of both outlines, as it is kept: in it, all that is born or dies has its place
//! and its time, where it meets nothing.

use super::births;
use super::drawings::Drawings;
use super::error::BuildError;
use super::guarded::Unproved;
use super::holes::{HoleOf, timed_by};
use super::levels::Levels;
use super::mirrored;
use super::note::Note;
use super::options::{Guarding, Options, Quality};
use super::parted::parted;
use super::spec::TransitionSpec;
use super::steps::Steps;
use super::unfolded::unfolded;
use crate::correspondence::{Prepared, RegionMatch};
use crate::progress::{Progress, checkpoint};
use crate::warp::{Arap, ArapOptions, Settled};

/// How often all that is born or dies is placed anew for what the proof found: of 60 pairs
/// of icons none was proved that took more than two.
const CLOSER: usize = 3;

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
    let parted = parted(&mut prepared, spec, progress)?;
    let notes = match spec.options.quality {
        Quality::Best => mirrored::note(spec, drawings, &parted.pieces, progress)?,
        Quality::Draft => None,
    };
    let matched = parted.matched;
    let levels = Levels::of(&matched, &drawings.looks);
    let arap = unfolded(parted.arap, progress)?;
    // What is held stiffer moves a little otherwise.
    let timetable = |holes: &[HoleOf]| {
        births::timetable(&matched, &arap, (holes, &levels), spec.options.quality)
    };
    let holes = timed_by(&matched.pieces, &arap, &levels, &timetable, progress)?;
    let film = Film {
        matched,
        arap,
        holes,
        swelling: Vec::new(),
        notes: notes.into_iter().collect(),
    };
    kept_apart(film, &levels, &spec.options, progress)
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
