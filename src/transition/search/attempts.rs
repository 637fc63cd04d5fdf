//! Searches for the best match of each piece.
//!
//! Boundary features cannot predict how the interior deforms, so each candidate match is rated by
//! its motion. Pieces move independently and are therefore chosen independently. The search starts
//! with the requested match and then makes the attempts of [`ATTEMPTS`] in their order:
//!
//! | attempt | pieces that it includes | match options | unmatched holes |
//! |---|---|---|---|
//! | [`CUT_HOLES`] | with unmatched holes, not stroked | requested | cut open or closed |
//! | [`UPRIGHT`] | that turn far | drawn orientation | as before |
//! | [`OTHER_COSTS`] | with dissimilar shapes | other stretch and inner costs | as before |
//! | [`WITHOUT_THICKNESS`] | that fold or distort much | no thickness | as before |
//! | [`UNPAIR_HOLES`] | that fold and have matched holes | requested | all holes |
//! | [`UPRIGHT`] to [`WITHOUT_THICKNESS`] again | of the previous attempt | as above | all holes |
//!
//! "As before" means as in the piece's best candidate so far. The last four attempts improve a
//! second result, which starts from that of [`CUT_HOLES`]. An attempt that would override a setting
//! of the user includes no piece. Designs with many rings keep the requested match, and a draft
//! only makes the attempt [`DRAFT`].
//!
//! Candidates are compared by folded faces over all steps, then by crossings of their outlines,
//! then by misfit: distortion, increased by excess turning, rotation and excess area. The earlier
//! one of equal candidates stays. Finally the correspondence of both results slides along the
//! outlines (see [`sliding`](super::sliding)), and the better result is chosen.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, MatchVariant, PieceResult, piece_of_result};
use super::sliding::{LOW_DISTORTION, slide_and_choose};
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchSettings};
use crate::transition::error::BuildError;
use crate::work::progress::{Progress, ProgressSpan};

/// Match cost above which shapes count as dissimilar, so that other costs are tried (heuristic: two
/// poses of one shape cost up to 0.3, dissimilar shapes 0.4 and more).
const SIMILAR_COST: f64 = 0.34;

/// Stretch costs tried for dissimilar shapes, after the default (heuristic).
const OTHER_STRETCH_COSTS: [f64; 2] = [0.6, 1.2];

/// Cost of inner distances in one variant for dissimilar shapes: with it, limbs and strokes
/// dominate the match (heuristic).
const INNER_DISTANCE_COST: f64 = 8.0;

/// Stretch costs tried without thickness if the candidates so far fold: with thickness, an arm can
/// be matched to a thick body (heuristic).
const COSTS_WITHOUT_THICKNESS: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// Distortion above which costs without thickness are tried even for a fold-free candidate
/// (heuristic).
const HIGH_DISTORTION: f64 = 3.0;

/// Maximum work of one attempt for a group: number of candidates times the square of a piece's
/// number of boundary vertices (resource limit: a candidate of 700 vertices takes about 0.3 s).
const MAX_WORK: usize = 2_500_000;

/// The same for drafts, for which the user is waiting (resource limit).
const MAX_DRAFT_WORK: usize = 100_000;

/// Unmatched holes are cut open or closed, whichever matches better.
const CUT_OR_CLOSE: HolePolicy = HolePolicy::Paired(HoleRule::Auto);

/// Fraction of the progress after the requested match (heuristic).
const REQUESTED_PROGRESS: f64 = 0.2;
/// Fraction of the progress after the requested match in a draft (heuristic).
const REQUESTED_DRAFT_PROGRESS: f64 = 0.7;
/// Fraction of the progress after all attempts (heuristic).
const ATTEMPTS_PROGRESS: f64 = 0.7;

/// An attempt to find better matches for some pieces of a group.
struct Attempt {
    /// Result that the attempt improves.
    branch: SearchBranch,
    /// Conditions that a piece must meet, all of them, to be included.
    conditions: &'static [PieceCondition],
    /// Match options that are tried.
    options: TriedOptions,
    /// Treatment of unmatched holes; `None` stands for that of each piece's best candidate so far.
    holes: Option<HolePolicy>,
    /// Limit of the work, measured as for [`MAX_WORK`]; the smallest pieces come first.
    max_work: usize,
    /// Fractions of the whole progress at the beginning and at the end (heuristic).
    progress: [f64; 2],
}

/// Result of the search that an attempt improves. There are two, which share their beginning.
enum SearchBranch {
    /// Both results.
    Both,
    /// The result in which holes may be matched.
    PairedHoles,
    /// The result in which all holes are unmatched.
    UnpairedHoles,
}

/// Condition under which an attempt includes a piece: a property of the user's settings, of the
/// group, or of the piece's result so far.
#[derive(Clone, Copy)]
enum PieceCondition {
    /// The user has not chosen a treatment of unmatched holes.
    FreeHoles,
    /// The user has not asked for the drawn orientation.
    FreeOrientation,
    /// The user has not set the stretch cost.
    FreeCosts,
    /// No line is drawn along the parts of the group: a cut through one would be visible.
    Unstroked,
    /// The piece has unmatched holes.
    UnmatchedHoles,
    /// The piece has matched holes, and folds or cannot be triangulated.
    FoldsWithHoles,
    /// All holes of the best candidate are unmatched.
    UnpairedHoles,
    /// The piece turns far, without being a rotated copy.
    TurnsFar,
    /// The matched shapes are dissimilar, or the piece cannot be triangulated.
    Dissimilar,
    /// The best candidate folds or distorts much, or the piece cannot be triangulated. Crossings do
    /// not count: including them would double the work and hardly ever help.
    HighDistortion,
}

/// Match options that an attempt tries, as changes to the requested ones.
#[derive(Clone, Copy)]
enum TriedOptions {
    /// The requested options.
    Requested,
    /// The drawn orientation.
    Upright,
    /// Other stretch costs, and a high cost of inner distances.
    OtherCosts,
    /// Several stretch costs without thickness.
    WithoutThickness,
}

/// All attempts in their order.
const ATTEMPTS: [Attempt; 8] = [
    CUT_HOLES,
    UPRIGHT,
    OTHER_COSTS,
    WITHOUT_THICKNESS,
    UNPAIR_HOLES,
    Attempt {
        branch: SearchBranch::UnpairedHoles,
        conditions: &[
            PieceCondition::UnpairedHoles,
            PieceCondition::FreeCosts,
            PieceCondition::FreeOrientation,
            PieceCondition::TurnsFar,
        ],
        progress: [0.6, 0.62],
        ..UPRIGHT
    },
    Attempt {
        branch: SearchBranch::UnpairedHoles,
        conditions: &[
            PieceCondition::UnpairedHoles,
            PieceCondition::FreeCosts,
            PieceCondition::Dissimilar,
        ],
        progress: [0.62, 0.66],
        ..OTHER_COSTS
    },
    Attempt {
        branch: SearchBranch::UnpairedHoles,
        conditions: &[
            PieceCondition::UnpairedHoles,
            PieceCondition::FreeCosts,
            PieceCondition::HighDistortion,
        ],
        progress: [0.66, ATTEMPTS_PROGRESS],
        ..WITHOUT_THICKNESS
    },
];

/// Cuts unmatched holes open or closes them, instead of letting them appear or disappear.
const CUT_HOLES: Attempt = Attempt {
    branch: SearchBranch::Both,
    conditions: &[
        PieceCondition::FreeHoles,
        PieceCondition::Unstroked,
        PieceCondition::UnmatchedHoles,
    ],
    options: TriedOptions::Requested,
    holes: Some(CUT_OR_CLOSE),
    max_work: usize::MAX,
    progress: [REQUESTED_PROGRESS, 0.3],
};

/// Matches in the drawn orientation what turns far.
const UPRIGHT: Attempt = Attempt {
    branch: SearchBranch::PairedHoles,
    conditions: &[
        PieceCondition::FreeCosts,
        PieceCondition::FreeOrientation,
        PieceCondition::TurnsFar,
    ],
    options: TriedOptions::Upright,
    holes: None,
    max_work: MAX_WORK,
    progress: [0.3, 0.34],
};

/// The only attempt of a draft.
const DRAFT: Attempt = Attempt {
    max_work: MAX_DRAFT_WORK,
    progress: [REQUESTED_DRAFT_PROGRESS, 1.0],
    ..UPRIGHT
};

/// Matches dissimilar shapes with other costs.
const OTHER_COSTS: Attempt = Attempt {
    branch: SearchBranch::PairedHoles,
    conditions: &[PieceCondition::FreeCosts, PieceCondition::Dissimilar],
    options: TriedOptions::OtherCosts,
    holes: None,
    max_work: MAX_WORK,
    progress: [0.34, 0.42],
};

/// Ignores thickness: such matches are worse and a last resort.
const WITHOUT_THICKNESS: Attempt = Attempt {
    branch: SearchBranch::PairedHoles,
    conditions: &[PieceCondition::FreeCosts, PieceCondition::HighDistortion],
    options: TriedOptions::WithoutThickness,
    holes: None,
    max_work: MAX_WORK,
    progress: [0.42, 0.5],
};

/// Leaves all holes unmatched.
const UNPAIR_HOLES: Attempt = Attempt {
    branch: SearchBranch::UnpairedHoles,
    conditions: &[PieceCondition::FreeHoles, PieceCondition::FoldsWithHoles],
    options: TriedOptions::Requested,
    holes: Some(HolePolicy::Unpaired),
    max_work: usize::MAX,
    progress: [0.5, 0.6],
};

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
    let mut paired = match drafts {
        Some(drafts) => drafts.clone(),
        None => group.requested_pieces(&ProgressSpan::new(progress, 0.0, REQUESTED_PROGRESS))?,
    };
    let mut unpaired: Vec<PieceResult> = Vec::new();
    if !group.plan.has_many_rings() {
        for attempt in &ATTEMPTS {
            match attempt.branch {
                SearchBranch::Both => {
                    attempt.run(group, &mut paired, progress)?;
                    unpaired = paired.clone();
                }
                SearchBranch::PairedHoles => attempt.run(group, &mut paired, progress)?,
                SearchBranch::UnpairedHoles => attempt.run(group, &mut unpaired, progress)?,
            }
        }
    }
    let has_unpaired_holes = |best: &MatchCandidate| best.holes == HolePolicy::Unpaired;
    let unpaired = unpaired
        .into_iter()
        .map(|result| result.ok().filter(has_unpaired_holes))
        .collect();
    let sliding = ProgressSpan::new(progress, ATTEMPTS_PROGRESS, 1.0);
    slide_and_choose(paired, unpaired, group.spec, &sliding)
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
    let requesting = ProgressSpan::new(progress, 0.0, REQUESTED_DRAFT_PROGRESS);
    let mut drafts = group.requested_pieces(&requesting)?;
    if !group.plan.has_many_rings() {
        DRAFT.run(group, &mut drafts, progress)?;
    }
    Ok(drafts)
}

impl Attempt {
    /// Tries the variants of this attempt for the pieces that meet its conditions, and replaces
    /// their results by better ones. `progress` is that of the whole search.
    ///
    /// # Errors
    /// If the work is cancelled.
    fn run(
        &self,
        group: &GroupSearch,
        results: &mut [PieceResult],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let [from, to] = self.progress;
        let progress = ProgressSpan::new(progress, from, to);
        let options = self.options.variants(&group.spec.options.matching);
        let includes = |result: &PieceResult| {
            let mut conditions = self.conditions.iter();
            conditions.all(|condition| condition.holds(group, result))
        };
        let included = affordable(results, &includes, options.len(), self.max_work);
        let policies: Vec<HolePolicy> = results
            .iter()
            .map(|result| self.hole_policy(group, result))
            .collect();
        // The pieces of a group are matched together, all with one policy.
        for policy in [
            group.initial_hole_policy(),
            CUT_OR_CLOSE,
            HolePolicy::Unpaired,
        ] {
            let wants: Vec<bool> = (policies.iter().zip(&included))
                .map(|(own_policy, is_included)| *is_included && *own_policy == policy)
                .collect();
            let variant = |options: &MatchOptions| MatchVariant {
                options: options.clone(),
                holes: policy,
            };
            let variants: Vec<MatchVariant> = options.iter().map(variant).collect();
            group.try_variants(results, &variants, &wants, &progress)?;
        }
        Ok(())
    }

    /// Returns how unmatched holes of a piece are treated.
    fn hole_policy(&self, group: &GroupSearch, result: &PieceResult) -> HolePolicy {
        match (self.holes, result) {
            (Some(policy), _) => policy,
            (None, Ok(best)) => best.holes,
            (None, Err(_)) => group.initial_hole_policy(),
        }
    }
}

impl PieceCondition {
    /// Returns whether a piece of the group with this result so far meets the condition.
    fn holds(self, group: &GroupSearch, result: &PieceResult) -> bool {
        let settings = &group.spec.options.matching;
        let matched = piece_of_result(result);
        let best = result.as_ref().ok();
        match self {
            Self::FreeHoles => settings.holes == HoleRule::Auto,
            Self::FreeOrientation => !settings.keep_up,
            Self::FreeCosts => settings.stretch.is_none(),
            Self::Unstroked => !group.plan.is_stroked(group.index),
            Self::UnmatchedHoles => matched.is_matched() && !matched.lone.is_empty(),
            Self::FoldsWithHoles => {
                let has_matched_holes = matched.is_matched() && matched.rings.len() > 1;
                has_matched_holes && best.is_none_or(MatchCandidate::folds)
            }
            Self::UnpairedHoles => best.is_some_and(|best| best.holes == HolePolicy::Unpaired),
            Self::TurnsFar => {
                best.is_some_and(|best| !best.stays_upright() && best.distortion > LOW_DISTORTION)
            }
            Self::Dissimilar => best
                .is_none_or(|best| best.matched.is_matched() && best.matched.cost > SIMILAR_COST),
            Self::HighDistortion => {
                best.is_none_or(|best| best.folds() || best.distortion > HIGH_DISTORTION)
            }
        }
    }
}

impl TriedOptions {
    /// Returns the options to try, given the user's settings.
    fn variants(self, settings: &MatchSettings) -> Vec<MatchOptions> {
        let requested = settings.options();
        let with_costs = |stretch: f64, thickness: f64| MatchOptions {
            stretch,
            thickness,
            ..requested.clone()
        };
        match self {
            Self::Requested => vec![requested.clone()],
            Self::Upright => vec![MatchOptions {
                keep_up: true,
                ..requested.clone()
            }],
            Self::OtherCosts => {
                let with_inner_distances = MatchOptions {
                    inner: INNER_DISTANCE_COST,
                    ..requested.clone()
                };
                OTHER_STRETCH_COSTS
                    .map(|stretch| with_costs(stretch, requested.thickness))
                    .into_iter()
                    .chain([with_inner_distances])
                    .collect()
            }
            Self::WithoutThickness => COSTS_WITHOUT_THICKNESS
                .map(|stretch| with_costs(stretch, 0.0))
                .to_vec(),
        }
    }
}

/// Returns which of the pieces selected by `includes` can be tried within `max_work`, the smallest
/// first, if each needs `candidates_per_piece` candidates.
fn affordable(
    results: &[PieceResult],
    includes: &dyn Fn(&PieceResult) -> bool,
    candidates_per_piece: usize,
    max_work: usize,
) -> Vec<bool> {
    let work = |k: usize| {
        let rings = piece_of_result(&results[k]).rings.iter();
        let vertices: usize = rings.map(|ring| ring.source.len()).sum();
        candidates_per_piece * vertices * vertices
    };
    let mut candidates: Vec<usize> = (0..results.len())
        .filter(|&k| includes(&results[k]))
        .collect();
    candidates.sort_by_key(|&k| work(k));
    let (mut total_work, mut selected) = (0, vec![false; results.len()]);
    for k in candidates {
        total_work += work(k);
        selected[k] = total_work <= max_work;
    }
    selected
}
