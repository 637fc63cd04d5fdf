//! Whether two designs would match far better if one of them were mirrored.
//!
//! A match turns and stretches, and never turns over: two springs that wind
//! against each other have none that is good. It is told and not done, since
//! a letter that is mirrored is no letter.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, PieceResult};
use crate::correspondence::{MatchPlan, PartLooks};
use crate::geometry::{Regions, Similarity, perimeter};
use crate::transition::drawing_pair::DrawingPair;
use crate::transition::error::BuildError;
use crate::transition::note::TransitionNote;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, still_wanted};

/// Films that distort less than this are good enough as they are.
const GOOD: f64 = 2.0;

/// Far better is a draft of the mirrored design that distorts by at most this
/// share of what the best film of the design as drawn does. Of 320 pairs of
/// icons, glyphs and silhouettes it is said of two: d and q, and a face.
const FAR_BETTER: f64 = 0.4;

/// What to say of it; none where nobody would gain by it.
pub(in crate::transition) fn mirror_note(
    spec: &TransitionSpec,
    drawings: &DrawingPair,
    best: &[MatchCandidate],
    progress: &dyn Progress,
) -> Result<Option<TransitionNote>, BuildError> {
    let asked = &spec.options.matching;
    let is_set_by_hand = !(asked.pins.is_empty()
        && asked.links.is_empty()
        && asked.lone.is_empty()
        && asked.cuts.is_empty());
    let as_drawn = distortion(best.iter());
    if is_set_by_hand || as_drawn < GOOD {
        return Ok(None);
    }
    let [source, target] = &drawings.outlines;
    let target = mirrored(target);
    let draft = draft(spec, [source, &target], &drawings.looks, progress);
    still_wanted(progress)?;
    // A film that was looked for longer may well have less trouble than a draft.
    let draft = draft.filter(|draft| !draft.iter().any(MatchCandidate::folds));
    let mirrored = draft.map(|draft| distortion(draft.iter()));
    let far_better = mirrored.filter(|mirrored| *mirrored < FAR_BETTER * as_drawn);
    Ok(far_better.map(|mirrored| TransitionNote::Mirrored { as_drawn, mirrored }))
}

/// The pieces of two designs as they are matched at first.
fn draft(
    spec: &TransitionSpec,
    designs: [&Regions; 2],
    looks: &PartLooks,
    progress: &dyn Progress,
) -> Option<Vec<MatchCandidate>> {
    let prepared = MatchPlan::new(designs, looks, &spec.options.matching, progress).ok()?;
    let groups = (0..prepared.groups().len()).map(|group| {
        let group = GroupSearch {
            prepared: &prepared,
            group,
            spec,
        };
        let pieces: Vec<PieceResult> = group.as_asked(progress).ok()?;
        pieces.into_iter().collect::<Result<Vec<_>, _>>().ok()
    });
    Some(groups.collect::<Option<Vec<_>>>()?.concat())
}

/// The mean distortion of the pieces of both designs, by their length.
fn distortion<'a>(pieces: impl Iterator<Item = &'a MatchCandidate>) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for piece in pieces.filter(|piece| piece.matched.is_in_both()) {
        let outer = piece.matched.rings.first();
        let length = outer.map_or(0.0, |ring| perimeter(&ring.source));
        (sum, total) = (sum + length * piece.distortion, total + length);
    }
    if total > 0.0 { sum / total } else { 1.0 }
}

/// A design turned over, left for right, its parts in their order.
fn mirrored(design: &Regions) -> Regions {
    let over = Similarity {
        mirror: true,
        ..Similarity::IDENTITY
    };
    design.transformed(&over)
}
