//! Checks whether two designs would match far better if one of them were mirrored.
//!
//! A match may turn and stretch a design but never mirror it, so two spirals of opposite handedness
//! have no good match. The result is only reported and not applied, since a mirrored letter, for
//! example, is no longer a letter.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, PieceResult};
use crate::correspondence::{MatchPlan, PartAppearances};
use crate::geometry::{Regions, Similarity, perimeter};
use crate::transition::drawing_pair::DrawingPair;
use crate::transition::error::BuildError;
use crate::transition::note::TransitionNote;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, check_cancelled};

/// Mirroring is not examined if the distortion of the best match as drawn is below this
/// (heuristic).
const GOOD: f64 = 2.0;

/// Mirroring counts as far better if the distortion of the draft match with one design mirrored is
/// below this fraction of the distortion of the best match as drawn (heuristic).
const FAR_BETTER: f64 = 0.4;

/// Returns a note if the designs would match far better if one of them were mirrored; otherwise
/// `None`. Also returns `None` if the user has set pins, links, cuts or unmatched parts by hand.
///
/// # Errors
/// If the work is cancelled.
pub(in crate::transition) fn mirror_note(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    best: &[MatchCandidate],
    progress: &dyn Progress,
) -> Result<Option<TransitionNote>, BuildError> {
    let requested = &spec.options.matching;
    let is_set_by_hand = !(requested.pins.is_empty()
        && requested.links.is_empty()
        && requested.lone.is_empty()
        && requested.cuts.is_empty());
    let as_drawn = distortion(best.iter());
    if is_set_by_hand || as_drawn < GOOD {
        return Ok(None);
    }
    let [source, target] = &drawings.outlines;
    let target = mirror(target);
    let draft = draft(spec, [source, &target], &drawings.appearances, progress);
    check_cancelled(progress)?;
    // A mirrored draft match that folds is no evidence that mirroring would help.
    let draft = draft.filter(|draft| !draft.iter().any(MatchCandidate::folds));
    let mirrored = draft.map(|draft| distortion(draft.iter()));
    let far_better = mirrored.filter(|mirrored| *mirrored < FAR_BETTER * as_drawn);
    Ok(far_better.map(|mirrored| TransitionNote::Mirrored { as_drawn, mirrored }))
}

/// Matches two designs with the requested options, without a search for better matches, and returns
/// the pieces; `None` if a piece cannot be matched or triangulated, or if there are very many rings.
fn draft(
    spec: &TransitionSpec,
    designs: [&Regions; 2],
    looks: &PartAppearances,
    progress: &dyn Progress,
) -> Option<Vec<MatchCandidate>> {
    let prepared = MatchPlan::new(designs, looks, &spec.options.matching, progress).ok()?;
    // With many rings, a second match of all pieces would take as long as the first.
    if prepared.has_many_rings() {
        return None;
    }
    let groups = (0..prepared.groups().len()).map(|group| {
        let group = GroupSearch {
            plan: &prepared,
            index: group,
            spec,
        };
        let pieces: Vec<PieceResult> = group.requested_pieces(progress).ok()?;
        pieces.into_iter().collect::<Result<Vec<_>, _>>().ok()
    });
    Some(groups.collect::<Option<Vec<_>>>()?.concat())
}

/// Returns the mean distortion of the matched pieces, weighted by the length of their outer outline
/// in the source; 1 if there are none.
fn distortion<'a>(pieces: impl Iterator<Item = &'a MatchCandidate>) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for piece in pieces.filter(|piece| piece.matched.is_matched()) {
        let outer = piece.matched.rings.first();
        let length = outer.map_or(0.0, |ring| perimeter(&ring.source));
        (sum, total) = (sum + length * piece.distortion, total + length);
    }
    if total > 0.0 { sum / total } else { 1.0 }
}

/// Returns a design mirrored left to right, with its parts in the same order.
fn mirror(design: &Regions) -> Regions {
    let flip = Similarity {
        mirror: true,
        ..Similarity::IDENTITY
    };
    design.transformed(&flip)
}
