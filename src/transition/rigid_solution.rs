//! The film of both outlines, as it is kept: in it, all that is born or dies has its place
//! and its time, where it meets nothing.

use super::collision_guard::FailedProof;
use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::note::TransitionNote;
use super::options::{BuildQuality, CollisionAvoidance, TransitionOptions};
use super::search::mirror_check;
use super::separation::separate;
use super::spec::TransitionSpec;
use super::stiffening::stiffen_folds;
use super::transients::holes::{PieceHole, timed_by};
use super::transients::layers::PieceLayers;
use super::transients::placement;
use super::transients::sample_times::SampleTimes;
use crate::correspondence::{MatchPlan, RegionMatch};
use crate::warp::{Arap, ArapOptions, OutlineParameters};
use crate::work::progress::{Progress, checkpoint};

/// How often all that is born or dies is placed anew for what the proof found: of 60 pairs
/// of icons none was proved that took more than two.
const CLOSER: usize = 3;

/// The film of both outlines, as it is settled: not subdivided.
#[derive(Clone, Debug)]
pub(super) struct RigidSolution {
    /// The match that was kept.
    pub matched: RegionMatch,
    pub arap: Arap,
    /// Holes that one of the designs has alone.
    pub holes: Vec<PieceHole>,
    /// The pieces that one of the designs has alone and that swell.
    pub swelling: Vec<usize>,
    pub notes: Vec<TransitionNote>,
}

/// The match of both outlines that is kept, and its film, settled.
pub(super) fn solve_best(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    progress: &dyn Progress,
) -> Result<RigidSolution, BuildError> {
    let designs = drawings.outlines.each_ref();
    checkpoint(progress, "matching", 0.0)?;
    let asked = &spec.options.matching;
    let mut prepared = MatchPlan::new(designs, &drawings.looks, asked, progress)?;
    let parted = separate(&mut prepared, spec, progress)?;
    let notes = match spec.options.quality {
        BuildQuality::Best => mirror_check::mirror_note(spec, drawings, &parted.pieces, progress)?,
        BuildQuality::Draft => None,
    };
    let matched = parted.matched;
    let levels = PieceLayers::of(&matched, &drawings.looks);
    let arap = stiffen_folds(parted.arap, progress)?;
    // What is held stiffer moves a little otherwise.
    let timetable = |holes: &[PieceHole]| {
        placement::timetable(&matched, &arap, (holes, &levels), spec.options.quality)
    };
    let holes = timed_by(&matched.pieces, &arap, &levels, &timetable, progress)?;
    let film = RigidSolution {
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
    film: RigidSolution,
    levels: &PieceLayers,
    options: &TransitionOptions,
    progress: &dyn Progress,
) -> Result<RigidSolution, BuildError> {
    let (mut steps, mut first, mut met) = (SampleTimes::default(), None, Vec::new());
    loop {
        let placed = placed(film.clone(), (levels, &steps), options.quality, progress)?;
        let arap = stiffen_folds(placed.arap, progress)?;
        let film = RigidSolution { arap, ..placed };
        if (options.quality, options.guard) != (BuildQuality::Best, CollisionAvoidance::Guarded) {
            return Ok(film);
        }
        let pieces = (film.matched.pieces.len(), &film.swelling[..]);
        let Some(unproved) = FailedProof::of(&film.arap, pieces, levels, progress)? else {
            return Ok(film);
        };
        let births = unproved.births();
        let now = (film, unproved);
        if births.is_empty() || met.len() == CLOSER || met.last() == Some(&births) {
            // What was looked at more closely in vain stays as it was at first.
            let kept = if births.is_empty() { None } else { first };
            let (film, unproved) = kept.unwrap_or(now);
            let arap = unproved.kept_apart(progress)?;
            return Ok(RigidSolution { arap, ..film });
        }
        births.iter().for_each(|&t| steps.look_at(t));
        met.push(births);
        first.get_or_insert(now);
    }
}

/// A settled film as the options ask for it.
pub(super) fn with_requested_options(
    settled: &Arap,
    asked: &ArapOptions,
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    if settled.options() == asked {
        return Ok(settled.clone());
    }
    stiffen_folds(settled.rebuilt(asked, progress)?, progress)
}

/// A film with all that is born or dies in its place and time.
fn placed(
    film: RigidSolution,
    (levels, steps): (&PieceLayers, &SampleTimes),
    quality: BuildQuality,
    progress: &dyn Progress,
) -> Result<RigidSolution, BuildError> {
    let options = film.arap.options();
    let there = (&film.holes[..], levels, steps);
    let placed = placement::placed(&film.matched, &film.arap, there, quality, progress)?;
    Ok(match placed {
        Some(placed) => {
            let settled = OutlineParameters {
                lives: &placed.lives,
                stiffness: film.arap.stiffness(),
            };
            RigidSolution {
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
