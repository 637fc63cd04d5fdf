//! Searches for the best match of each piece.
//!
//! Boundary features cannot predict how the interior deforms, so each candidate match is rated by
//! its motion. Pieces move independently and are therefore chosen independently. Attempts, in this
//! order:
//!
//! - the requested costs, with unmatched holes appearing or disappearing on their own
//! - the same with unmatched holes cut open or closed
//! - the drawn orientation, for pieces that turn far
//! - other stretch costs and a high cost of inner distances, for dissimilar shapes
//! - stretch costs without thickness, if the best candidate folds or distorts much
//! - if the requested match folds with its holes: all of the above with all holes unmatched
//!
//! Candidates are compared by folded faces over all steps, then by crossings of their outlines,
//! then by misfit: distortion, increased by excess turning, rotation and excess area. The earlier
//! one of equal candidates stays. Finally the boundary correspondence of the best candidate slides
//! along the outlines as long as that improves it; if holes were also tried unmatched, both results
//! slide before one is chosen. A draft only tries the requested match and the drawn orientation.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, MatchVariant, PieceResult, piece, take_better};
use crate::compatible::slide_outlines;
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchSettings};
use crate::transition::error::BuildError;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, still_wanted};
use rayon::prelude::*;

/// Match cost above which shapes count as dissimilar, so that other costs are tried (heuristic: two
/// poses of one shape cost up to 0.3, dissimilar shapes 0.4 and more).
const SIMILAR_COST: f64 = 0.34;

/// Stretch costs tried for dissimilar shapes, after the default (heuristic).
const OTHER_STRETCH_COSTS: [f64; 2] = [0.6, 1.2];

/// Cost of inner distances in one attempt for dissimilar shapes: with it, limbs and strokes
/// dominate the match (heuristic).
const INNER_DISTANCE_COST: f64 = 8.0;

/// Stretch costs tried without thickness if the candidates so far fold: with thickness, an arm can
/// be matched to a thick body (heuristic).
const COSTS_WITHOUT_THICKNESS: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// Distortion above which costs without thickness are tried even for a fold-free candidate
/// (heuristic).
const HIGH_DISTORTION: f64 = 3.0;

/// Maximum work of one round for a group: number of candidates times the square of a piece's number
/// of boundary vertices (resource limit: a candidate of 700 vertices takes about 0.3 s).
const MAX_WORK: usize = 2_500_000;

/// The same for drafts, for which the user is waiting (resource limit).
const MAX_DRAFT_WORK: usize = 100_000;

/// Unmatched holes are cut open or closed, whichever matches better.
const CUT_HOLES: HolePolicy = HolePolicy::By(HoleRule::Auto);

/// Fraction of the progress after the requested match (heuristic).
const REQUESTED_PROGRESS: f64 = 0.2;
/// Fraction of the progress after the attempt with cut holes (heuristic).
const CUT_PROGRESS: f64 = 0.3;
/// Fraction of the progress after the other costs (heuristic).
const OTHER_COSTS_PROGRESS: f64 = 0.5;
/// Fraction of the progress after the requested match with all holes unmatched (heuristic).
const UNMATCHED_PROGRESS: f64 = 0.6;
/// Fraction of the progress after the other costs with all holes unmatched (heuristic).
const UNMATCHED_COSTS_PROGRESS: f64 = 0.7;

/// Maximum number of times that a piece slides (resource limit).
const MAX_SLIDES: u32 = 3;

/// Distortion below which a map is not improved further: two drawings of one shape (heuristic).
const LOW_DISTORTION: f64 = 1.02;

/// Returns the best candidate of each piece of a group. `drafts` are the same pieces with the
/// requested match, if known.
///
/// # Errors
/// If the group cannot be matched, a motion cannot be solved, or the work is cancelled.
pub(in crate::transition) fn best_of_group(
    group: &GroupSearch,
    drafts: Option<&Vec<PieceResult>>,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    let span = |from, to| ProgressSpan::new(progress, from, to);
    let mut chosen = match drafts {
        Some(drafts) => drafts.clone(),
        None => group.as_asked(&span(0.0, REQUESTED_PROGRESS))?,
    };
    let mut without_holes = Vec::new();
    if !group.prepared.is_crowd() {
        if !group.prepared.is_lined(group.group) {
            let have_unmatched_holes: Vec<bool> = chosen.iter().map(has_unmatched_holes).collect();
            let progress = span(REQUESTED_PROGRESS, CUT_PROGRESS);
            group.try_holes(&mut chosen, CUT_HOLES, &have_unmatched_holes, &progress)?;
        }
        let have_folding_holes: Vec<bool> = chosen.iter().map(has_folding_holes).collect();
        let mut others = chosen.clone();
        let progress = span(CUT_PROGRESS, OTHER_COSTS_PROGRESS);
        group.try_orientation_and_costs(&mut chosen, &|_| true, &progress)?;
        let progress = span(OTHER_COSTS_PROGRESS, UNMATCHED_PROGRESS);
        group.try_holes(
            &mut others,
            HolePolicy::Unpaired,
            &have_folding_holes,
            &progress,
        )?;
        let progress = span(UNMATCHED_PROGRESS, UNMATCHED_COSTS_PROGRESS);
        group.try_orientation_and_costs(&mut others, &has_no_matched_holes, &progress)?;
        let others = others.into_iter().map(Some);
        without_holes = others
            .map(|other| other.filter(has_no_matched_holes))
            .collect();
    }
    let last = span(UNMATCHED_COSTS_PROGRESS, 1.0);
    let shares = ProgressShares::new(&last, chosen.len());
    let slide = |chosen: PieceResult, progress: &dyn Progress| -> Result<PieceResult, BuildError> {
        Ok(match chosen {
            Ok(best) => Ok(improved_by_sliding(best, group.spec, progress)?),
            none => none,
        })
    };
    without_holes.resize_with(chosen.len(), || None);
    let pairs = chosen.into_par_iter().zip(without_holes).enumerate();
    let best = pairs.map(|(k, (chosen, without_holes))| {
        let share = shares.part(k);
        let Some(without_holes) = without_holes else {
            return Ok(vec![slide(chosen, &share)?]);
        };
        let [first, second] =
            [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(&share, a, b));
        let mut best = vec![slide(chosen, &first)?];
        // Compare only after sliding, which can repair a pairing of holes that folds, as in D and
        // P.
        take_better(&mut best, vec![slide(without_holes, &second)?.ok()]);
        Ok(best)
    });
    let best: Vec<Vec<PieceResult>> = best.collect::<Result<_, BuildError>>()?;
    Ok(best.concat())
}

/// Returns the draft of each piece: the requested match, or the drawn orientation for pieces that
/// would turn far.
///
/// # Errors
/// If the group cannot be matched, a motion cannot be solved, or the work is cancelled.
pub(in crate::transition) fn drafts_of_group(
    group: &GroupSearch,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    let [asking, turning] =
        [(0.0, 0.7), (0.7, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
    let mut chosen = group.as_asked(&asking)?;
    if !group.prepared.is_crowd() {
        group.try_upright(&mut chosen, (&|_| true, MAX_DRAFT_WORK), &turning)?;
    }
    Ok(chosen)
}

impl GroupSearch<'_> {
    /// Tries the requested costs with another treatment of holes, for the pieces selected by
    /// `wants`.
    fn try_holes(
        &self,
        chosen: &mut [PieceResult],
        holes: HolePolicy,
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let requested = &self.spec.options.matching;
        if requested.holes != HoleRule::Auto {
            return Ok(());
        }
        let options = requested.options();
        self.try_ways(chosen, &[MatchVariant { options, holes }], wants, progress)
    }

    /// Tries the drawn orientation and other costs, for the pieces selected by `is_selected`.
    fn try_orientation_and_costs(
        &self,
        chosen: &mut [PieceResult],
        is_selected: &dyn Fn(&PieceResult) -> bool,
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let [turning, trying_costs] =
            [(0.0, 0.2), (0.2, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        self.try_upright(chosen, (is_selected, MAX_WORK), &turning)?;
        self.try_other_costs(chosen, is_selected, &trying_costs)
    }

    /// Tries other costs for dissimilar shapes, then costs without thickness where the best
    /// candidate is poor.
    fn try_other_costs(
        &self,
        chosen: &mut [PieceResult],
        is_selected: &dyn Fn(&PieceResult) -> bool,
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let spans = [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        let cost_rounds = cost_rounds(&self.spec.options.matching);
        for (k, (round, span)) in cost_rounds.iter().zip(&spans).enumerate() {
            let wants = |chosen: &PieceResult| match chosen {
                Err(_) => true,
                Ok(best) if k == 0 => best.matched.is_in_both() && best.matched.cost > SIMILAR_COST,
                // Costs without thickness match worse and are a last resort. Crossings alone do not
                // justify them: that would double the work and hardly ever help.
                Ok(best) => best.folds() || best.distortion > HIGH_DISTORTION,
            };
            let wants = |chosen: &PieceResult| is_selected(chosen) && wants(chosen);
            let wants = affordable(chosen, &wants, round.len(), MAX_WORK);
            self.try_with_best_holes(chosen, round, &wants, span)?;
        }
        Ok(())
    }

    /// Tries the drawn orientation for the pieces that turn far.
    fn try_upright(
        &self,
        chosen: &mut [PieceResult],
        (is_selected, max_work): (&dyn Fn(&PieceResult) -> bool, usize),
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let requested = &self.spec.options.matching;
        if requested.stretch.is_some() || requested.keep_up {
            return Ok(());
        }
        let upright = MatchOptions {
            keep_up: true,
            ..requested.options()
        };
        let is_wanted = |chosen: &PieceResult| is_selected(chosen) && turns_far(chosen);
        let wants = affordable(chosen, &is_wanted, 1, max_work);
        self.try_with_best_holes(chosen, &[upright], &wants, progress)
    }

    /// Tries several options for the pieces selected by `wants`, with the treatment of holes that
    /// is best for each piece so far.
    fn try_with_best_holes(
        &self,
        chosen: &mut [PieceResult],
        options: &[MatchOptions],
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let best_policy = |chosen: &PieceResult| match chosen {
            Ok(best) => best.holes,
            Err(_) => self.first_holes(),
        };
        let best_policies: Vec<HolePolicy> = chosen.iter().map(best_policy).collect();
        for current in [self.first_holes(), CUT_HOLES, HolePolicy::Unpaired] {
            let variant = |options: &MatchOptions| MatchVariant {
                options: options.clone(),
                holes: current,
            };
            let variants: Vec<MatchVariant> = options.iter().map(variant).collect();
            let wants: Vec<bool> = (best_policies.iter().zip(wants))
                .map(|(policy, wants)| *wants && *policy == current)
                .collect();
            self.try_ways(chosen, &variants, &wants, progress)?;
        }
        Ok(())
    }
}

/// Returns which of the pieces selected by `wants` can be tried within `max_work`, the smallest
/// first, if each needs `candidates_per_piece` candidates.
fn affordable(
    chosen: &[PieceResult],
    wants: &dyn Fn(&PieceResult) -> bool,
    candidates_per_piece: usize,
    max_work: usize,
) -> Vec<bool> {
    let work = |k: usize| {
        let rings = piece(&chosen[k]).rings.iter();
        let vertices: usize = rings.map(|ring| ring.source.len()).sum();
        candidates_per_piece * vertices * vertices
    };
    let mut candidates: Vec<usize> = (0..chosen.len()).filter(|&k| wants(&chosen[k])).collect();
    candidates.sort_by_key(|&k| work(k));
    let (mut total_work, mut selected) = (0, vec![false; chosen.len()]);
    for k in candidates {
        total_work += work(k);
        selected[k] = total_work <= max_work;
    }
    selected
}

/// Returns whether the piece turns far, without being a rotated copy.
fn turns_far(chosen: &PieceResult) -> bool {
    let is_far = |best: &MatchCandidate| !best.is_upright() && best.distortion > LOW_DISTORTION;
    chosen.as_ref().is_ok_and(is_far)
}

/// Returns whether the piece has unmatched holes.
fn has_unmatched_holes(chosen: &PieceResult) -> bool {
    let piece = piece(chosen);
    piece.is_in_both() && !piece.lone.is_empty()
}

/// Returns whether the piece has matched holes and folds.
fn has_folding_holes(chosen: &PieceResult) -> bool {
    let piece = piece(chosen);
    let folds = chosen.as_ref().map_or(true, MatchCandidate::folds);
    piece.is_in_both() && piece.rings.len() > 1 && folds
}

/// Returns whether the best candidate leaves all holes unmatched.
fn has_no_matched_holes(chosen: &PieceResult) -> bool {
    chosen
        .as_ref()
        .is_ok_and(|best| best.holes == HolePolicy::Unpaired)
}

/// Slides the boundary correspondence of a candidate along the outlines as long as that improves
/// its motion.
///
/// # Errors
/// If the work is cancelled.
fn improved_by_sliding(
    mut best: MatchCandidate,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<MatchCandidate, BuildError> {
    for round in 0..MAX_SLIDES {
        if !best.matched.is_in_both() || best.distortion < LOW_DISTORTION {
            break;
        }
        let fraction_after = |k: u32| f64::from(k) / f64::from(MAX_SLIDES);
        let progress =
            &ProgressSpan::new(progress, fraction_after(round), fraction_after(round + 1));
        let options = &spec.options.triangulation;
        let places = slide_outlines(&best.matched, &best.mesh, options, progress);
        still_wanted(progress)?;
        let Some(places) = places else { break };
        let moved = best.matched.moved(&places);
        let moved = MatchCandidate::new(moved, best.holes, &spec.options, progress).ok();
        still_wanted(progress)?;
        match moved {
            Some(moved) if moved.is_better_than(&best) => best = moved,
            _ => break,
        }
    }
    Ok(best)
}

/// Returns the costs that are tried after the requested ones, round by round; none if the user has
/// set the stretch cost.
fn cost_rounds(requested: &MatchSettings) -> Vec<Vec<MatchOptions>> {
    if requested.stretch.is_some() {
        return Vec::new();
    }
    let requested = requested.options();
    let with_costs = |stretch: f64, thickness: f64| MatchOptions {
        stretch,
        thickness,
        ..requested.clone()
    };
    let with_inner_distances = MatchOptions {
        inner: INNER_DISTANCE_COST,
        ..requested.clone()
    };
    let mut others = OTHER_STRETCH_COSTS
        .map(|stretch_cost| with_costs(stretch_cost, requested.thickness))
        .to_vec();
    others.push(with_inner_distances);
    vec![
        others,
        COSTS_WITHOUT_THICKNESS
            .map(|stretch_cost| with_costs(stretch_cost, 0.0))
            .to_vec(),
    ]
}
