//! Solves the motion of matched outlines. Gives unmatched parts and holes a position and a time
//! window in which they collide with nothing, as far as possible.

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

/// Maximum number of times that unmatched parts are placed again after the check at every t has
/// failed (resource limit: two suffice for all icons tested).
const MAX_REFINEMENTS: usize = 3;

/// The solved motion of two outlines, before subdivision.
#[derive(Clone, Debug)]
pub(super) struct RigidSolution {
    /// The match that was chosen.
    pub matched: RegionMatch,
    /// The interpolation of all pieces, without subdivision.
    pub arap: Arap,
    /// Holes that exist in only one design.
    pub holes: Vec<PieceHole>,
    /// Indices of the unmatched pieces that swell: they keep their outer size and grow in
    /// thickness, within their outline.
    pub swelling: Vec<usize>,
    /// Deviations from the request, and suggestions.
    pub notes: Vec<TransitionNote>,
}

/// Finds the best match of two outlines and solves its motion.
///
/// # Errors
/// If outlines cannot be matched or triangulated, are too large, or the work is cancelled.
pub(super) fn solve_best(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    progress: &dyn Progress,
) -> Result<RigidSolution, BuildError> {
    let designs = drawings.outlines.each_ref();
    checkpoint(progress, "matching", 0.0)?;
    let requested = &spec.options.matching;
    let mut prepared = MatchPlan::new(designs, &drawings.appearances, requested, progress)?;
    let separation = separate(&mut prepared, spec, progress)?;
    let notes = match spec.options.quality {
        BuildQuality::Best => {
            mirror_check::mirror_note(spec, drawings, &separation.pieces, progress)?
        }
        BuildQuality::Draft => None,
    };
    let matched = separation.matched;
    let layers = PieceLayers::of(&matched, &drawings.appearances);
    let arap = stiffen_folds(separation.arap, progress)?;
    // The time windows of the holes are chosen for the motion after `stiffen_folds`, because that
    // is the motion that is shown.
    let schedule_for = |holes: &[PieceHole]| {
        placement::timetable(&matched, &arap, (holes, &layers), spec.options.quality)
    };
    let holes = timed_by(&matched.pieces, &arap, &layers, &schedule_for, progress)?;
    let solution = RigidSolution {
        matched,
        arap,
        holes,
        swelling: Vec::new(),
        notes: notes.into_iter().collect(),
    };
    without_collisions(solution, &layers, &spec.options, progress)
}

/// Places unmatched parts so that nothing collides at any t, as far as possible.
///
/// If the check at every t finds that an unmatched part collides between two sample times, the t of
/// the collision becomes another sample time and all unmatched parts are placed again.
///
/// # Errors
/// If the motion cannot be solved or the work is cancelled.
fn without_collisions(
    solution: RigidSolution,
    layers: &PieceLayers,
    options: &TransitionOptions,
    progress: &dyn Progress,
) -> Result<RigidSolution, BuildError> {
    let (mut sample_times, mut first) = (SampleTimes::default(), None);
    let mut previous_collisions = Vec::new();
    loop {
        let (mut placed, unsearched) = place_unmatched_parts(
            solution.clone(),
            layers,
            &sample_times,
            options.quality,
            progress,
        )?;
        if unsearched > 0 {
            let note = TransitionNote::PartsUnsearched { parts: unsearched };
            placed.notes.push(note);
        }
        let arap = stiffen_folds(placed.arap, progress)?;
        let solution = RigidSolution { arap, ..placed };
        if (options.quality, options.guard) != (BuildQuality::Best, CollisionAvoidance::On) {
            return Ok(solution);
        }
        let pieces = (solution.matched.pieces.len(), &solution.swelling[..]);
        let Some(failed_proof) = FailedProof::of(&solution.arap, pieces, layers, progress)? else {
            return Ok(solution);
        };
        let collision_times = failed_proof.births();
        let current = (solution, failed_proof);
        // A search that reached its limit of work is not repeated.
        if collision_times.is_empty()
            || unsearched > 0
            || previous_collisions.len() == MAX_REFINEMENTS
            || previous_collisions.last() == Some(&collision_times)
        {
            // If collisions remain although the parts were placed again, the first placement is
            // used.
            let restored = if collision_times.is_empty() {
                None
            } else {
                first
            };
            let (solution, failed_proof) = restored.unwrap_or(current);
            let arap = failed_proof.kept_apart(progress)?;
            return Ok(RigidSolution { arap, ..solution });
        }
        collision_times
            .iter()
            .for_each(|&t| sample_times.refine_at(t));
        previous_collisions.push(collision_times);
        first.get_or_insert(current);
    }
}

/// Rebuilds a solved motion with the requested options, such as subdivision.
///
/// # Errors
/// If the motion cannot be solved or the work is cancelled.
pub(super) fn with_requested_options(
    solved: &Arap,
    requested: &ArapOptions,
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    if solved.options() == requested {
        return Ok(solved.clone());
    }
    stiffen_folds(solved.rebuilt(requested, progress)?, progress)
}

/// Gives each unmatched part a position and a time window. Also returns the number of parts whose
/// positions were not searched, because the search had reached its limit of work.
///
/// # Errors
/// If the motion cannot be solved or the work is cancelled.
fn place_unmatched_parts(
    solution: RigidSolution,
    layers: &PieceLayers,
    sample_times: &SampleTimes,
    quality: BuildQuality,
    progress: &dyn Progress,
) -> Result<(RigidSolution, usize), BuildError> {
    let options = solution.arap.options();
    let obstacles = (&solution.holes[..], layers, sample_times);
    let placed = placement::placed(
        &solution.matched,
        &solution.arap,
        obstacles,
        quality,
        progress,
    )?;
    Ok(match placed {
        Some(placed) => {
            let parameters = OutlineParameters {
                time_windows: &placed.lives,
                stiffness: solution.arap.stiffness(),
            };
            let placed_solution = RigidSolution {
                arap: Arap::with_outline_parameters(&placed.mesh, options, parameters, progress)?,
                matched: placed.matched,
                swelling: placed.swelling,
                // The holes stay valid, because they lie in matched pieces, which were not moved.
                ..solution
            };
            (placed_solution, placed.unsearched)
        }
        None => (solution, 0),
    })
}
