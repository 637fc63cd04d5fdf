//! Searches for the best match of each piece.
//!
//! Boundary features cannot predict how the interior deforms, so each candidate match is rated by
//! its motion. Pieces move independently and are therefore chosen independently. The search starts
//! with the draft match of each piece, or with the requested match if there is no draft. It then
//! makes the attempts of [`ATTEMPTS`] in order:
//!
//! | attempt | pieces that it includes | match options | holes |
//! |---|---|---|---|
//! | [`CUT_HOLES`] | with unmatched holes, no stroke | requested | cut open or closed |
//! | [`UPRIGHT`] | that turn far | drawn orientation | as before |
//! | [`OTHER_COSTS`] | with dissimilar shapes | other stretch and inner costs | as before |
//! | [`WITHOUT_THICKNESS`] | that fold or distort much | no thickness | as before |
//! | [`UNPAIR_HOLES`] | that fold and have matched holes | requested | all unmatched |
//! | [`UPRIGHT`] to [`WITHOUT_THICKNESS`] again | of the previous attempt | as above | as above |
//!
//! "As before" means as in the piece's best match so far. The last four attempts improve a second
//! result, which starts from the result of [`CUT_HOLES`]. An attempt that would override a setting
//! of the user includes no pieces. Designs with many rings keep the requested match. In draft
//! quality, only the attempt [`DRAFT`] is made.
//!
//! Candidates are compared by the number of folded faces, summed over sampled t, then by the
//! crossings of their outlines, then by misfit: the distortion, multiplied by factors for the
//! rotation of the piece and for additional bends and area during the motion. If two candidates are
//! equal, the earlier one stays. Finally the correspondence of both results slides along the
//! outlines (see [`sliding`](super::sliding)), and the better result is chosen.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, MatchVariant, PieceResult, piece_of_result};
use super::sliding::{LOW_DISTORTION, slide_and_choose};
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchSettings};
use crate::transition::error::BuildError;
use crate::work::progress::{Progress, ProgressSpan};

/// Match cost above which shapes count as dissimilar, so that the attempt [`OTHER_COSTS`] is made
/// (heuristic: two poses of one shape cost up to 0.3, dissimilar shapes 0.4 and more).
const SIMILAR_COST: f64 = 0.34;

/// Weights of the cost of stretching that are tried for dissimilar shapes, in addition to the
/// requested weight (heuristic).
const OTHER_STRETCH_COSTS: [f64; 2] = [0.6, 1.2];

/// Weight of inner distances (lengths of shortest paths inside the shape) in one of the variants
/// tried for dissimilar shapes. With this weight, limbs and strokes dominate the match (heuristic).
const INNER_DISTANCE_COST: f64 = 8.0;

/// Weights of the cost of stretching that are tried, with thickness ignored, if the matches so far
/// fold or are distorted. If thickness counts, a match may map an arm to a thick body (heuristic).
const COSTS_WITHOUT_THICKNESS: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// Distortion of the best match above which matches without thickness are tried even if the best
/// match does not fold (heuristic).
const HIGH_DISTORTION: f64 = 3.0;

/// Maximum work of one attempt for a group of parts. The work of a piece is the number of matches
/// tried for it times the square of the number of its boundary vertices (resource limit: a match
/// with 700 vertices takes about 0.3 s).
const MAX_WORK: usize = 2_500_000;

/// Maximum work of the only attempt in draft quality, measured as for [`MAX_WORK`] (resource limit:
/// the user is waiting for the draft).
const MAX_DRAFT_WORK: usize = 100_000;

/// Treatment of unmatched holes in which they are cut open or closed, whichever matches better.
const CUT_OR_CLOSE: HolePolicy = HolePolicy::Paired(HoleRule::Auto);

/// Progress reported once the requested matches are done, in [0, 1] (heuristic).
const REQUESTED_PROGRESS: f64 = 0.2;
/// Progress of a draft reported once the requested matches are done, in [0, 1] (heuristic).
const REQUESTED_DRAFT_PROGRESS: f64 = 0.7;
/// Progress reported once all attempts are made, in [0, 1] (heuristic).
const ATTEMPTS_PROGRESS: f64 = 0.7;

/// An attempt to find better matches for some pieces of a group of parts.
struct Attempt {
    /// Result of the search that the attempt improves.
    branch: SearchBranch,
    /// The attempt includes the pieces that meet all of these conditions.
    conditions: &'static [PieceCondition],
    /// Match options that are tried.
    options: TriedOptions,
    /// Treatment of unmatched holes. If `None`, each piece keeps the treatment in its best match so
    /// far.
    holes: Option<HolePolicy>,
    /// Limit of the work, measured as for [`MAX_WORK`]. The smallest pieces are tried first; pieces
    /// beyond the limit are left out.
    max_work: usize,
    /// Progress of the whole search, in [0, 1], when the attempt begins and when it ends
    /// (heuristic).
    progress: [f64; 2],
}

/// Result of the search that an attempt improves. The search keeps two results, which are equal
/// until [`CUT_HOLES`] has been tried.
enum SearchBranch {
    /// Both results of the search.
    Both,
    /// The result in which holes of the source may be matched with holes of the target.
    PairedHoles,
    /// The result in which all holes of some pieces are left unmatched.
    UnpairedHoles,
}

/// Condition under which an attempt includes a piece: a property of the user's settings, of the
/// group, or of the piece's result so far.
#[derive(Clone, Copy)]
enum PieceCondition {
    /// The user has not chosen a treatment of unmatched holes.
    FreeHoles,
    /// The user has not requested the drawn orientation.
    FreeOrientation,
    /// The user has not set the weight of stretching.
    FreeCosts,
    /// The parts of the group have no stroke: a cut through a stroke would be visible.
    Unstroked,
    /// The piece exists in both designs and has unmatched holes.
    UnmatchedHoles,
    /// The piece has matched holes, and folds or cannot be triangulated.
    FoldsWithHoles,
    /// In the best match of the piece so far, all holes are unmatched.
    UnpairedHoles,
    /// The piece turns far, and its target is not just a rotated copy.
    TurnsFar,
    /// The matched shapes are dissimilar, or the piece cannot be triangulated.
    Dissimilar,
    /// The best match so far folds or has a high distortion, or the piece cannot be triangulated.
    /// Crossing outlines alone are no reason to include a piece: that would double the work and
    /// hardly ever help.
    HighDistortion,
}

/// Match options that an attempt tries, as changes to the requested ones.
#[derive(Clone, Copy)]
enum TriedOptions {
    /// The requested options.
    Requested,
    /// The requested options, except that the drawn orientation is kept.
    Upright,
    /// The weights [`OTHER_STRETCH_COSTS`], and a high weight of inner distances.
    OtherCosts,
    /// The weights [`COSTS_WITHOUT_THICKNESS`], with thickness ignored.
    WithoutThickness,
}

/// All attempts, in the order in which they are made.
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

/// Attempt that cuts unmatched holes open or closes them, instead of letting them appear or
/// disappear.
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

/// Attempt for pieces that turn far: keeps their drawn orientation.
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

/// The only attempt in draft quality. Like [`UPRIGHT`], it keeps the drawn orientation of pieces
/// that turn far, but it does less work.
const DRAFT: Attempt = Attempt {
    max_work: MAX_DRAFT_WORK,
    progress: [REQUESTED_DRAFT_PROGRESS, 1.0],
    ..UPRIGHT
};

/// Attempt that matches dissimilar shapes with other weights.
const OTHER_COSTS: Attempt = Attempt {
    branch: SearchBranch::PairedHoles,
    conditions: &[PieceCondition::FreeCosts, PieceCondition::Dissimilar],
    options: TriedOptions::OtherCosts,
    holes: None,
    max_work: MAX_WORK,
    progress: [0.34, 0.42],
};

/// Attempt that ignores thickness. Such matches are usually worse, so this is a last resort.
const WITHOUT_THICKNESS: Attempt = Attempt {
    branch: SearchBranch::PairedHoles,
    conditions: &[PieceCondition::FreeCosts, PieceCondition::HighDistortion],
    options: TriedOptions::WithoutThickness,
    holes: None,
    max_work: MAX_WORK,
    progress: [0.42, 0.5],
};

/// Attempt that leaves all holes unmatched.
const UNPAIR_HOLES: Attempt = Attempt {
    branch: SearchBranch::UnpairedHoles,
    conditions: &[PieceCondition::FreeHoles, PieceCondition::FoldsWithHoles],
    options: TriedOptions::Requested,
    holes: Some(HolePolicy::Unpaired),
    max_work: usize::MAX,
    progress: [0.5, 0.6],
};

/// Returns the best match of each piece of a group of parts. `drafts` holds the result of
/// [`drafts_of_group`], if it has been computed already.
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
    if group.plan.has_many_rings() {
        return Ok(paired);
    }
    let mut unpaired: Vec<PieceResult> = Vec::new();
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
    let has_unpaired_holes = |best: &MatchCandidate| best.holes == HolePolicy::Unpaired;
    let unpaired = unpaired
        .into_iter()
        .map(|result| result.ok().filter(has_unpaired_holes))
        .collect();
    let sliding = ProgressSpan::new(progress, ATTEMPTS_PROGRESS, 1.0);
    let holes_touch = group.plan.has_contacts(group.index);
    slide_and_choose(paired, unpaired, holes_touch, group.spec, &sliding)
}

/// Returns the draft match of each piece of a group of parts: the requested match or, for pieces
/// that would turn far, a match that keeps them upright, if that is better.
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
    /// their results by better ones. `progress` covers the whole search.
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
        // The pieces of a group are matched together and with one treatment of holes, so each
        // treatment is tried separately.
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

    /// Returns how this attempt treats the unmatched holes of a piece.
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
    /// Returns the match options to try, given the user's settings.
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

/// Returns, for each piece, whether it is tried. Of the pieces that `includes` selects, the
/// smallest ones are tried as long as their total work is at most `max_work`. For each piece,
/// `candidates_per_piece` matches would be tried.
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
