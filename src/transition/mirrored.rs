//! Whether two designs would match far better if one of them were mirrored.
//!
//! A match turns and stretches, and never turns over: two springs that wind
//! against each other have none that is good. It is told and not done, since
//! a letter that is mirrored is no letter.

use super::candidate::Candidate;
use super::drawings::Drawings;
use super::error::BuildError;
use super::group::{Chosen, GroupOf};
use super::note::Note;
use super::spec::TransitionSpec;
use crate::correspondence::{Looks, Prepared};
use crate::geometry::{Regions, Similarity, perimeter};
use crate::progress::{Progress, still_wanted};

/// Films that distort less than this are good enough as they are.
const GOOD: f64 = 2.0;

/// Far better is a draft of the mirrored design that distorts by at most this
/// share of what the best film of the design as drawn does. Of 320 pairs of
/// icons, glyphs and silhouettes it is said of two: d and q, and a face.
const FAR_BETTER: f64 = 0.4;

/// What to say of it; none where nobody would gain by it.
pub(super) fn note(
    spec: &TransitionSpec,
    drawings: &Drawings,
    best: &[Candidate],
    progress: &dyn Progress,
) -> Result<Option<Note>, BuildError> {
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
    let draft = draft.filter(|draft| !draft.iter().any(Candidate::folds));
    let mirrored = draft.map(|draft| distortion(draft.iter()));
    let far_better = mirrored.filter(|mirrored| *mirrored < FAR_BETTER * as_drawn);
    Ok(far_better.map(|mirrored| Note::Mirrored { as_drawn, mirrored }))
}

/// The pieces of two designs as they are matched at first.
fn draft(
    spec: &TransitionSpec,
    designs: [&Regions; 2],
    looks: &Looks,
    progress: &dyn Progress,
) -> Option<Vec<Candidate>> {
    let prepared = Prepared::new(designs, looks, &spec.options.matching, progress).ok()?;
    let groups = (0..prepared.groups().len()).map(|group| {
        let group = GroupOf {
            prepared: &prepared,
            group,
            spec,
        };
        let pieces: Vec<Chosen> = group.as_asked(progress).ok()?;
        pieces.into_iter().collect::<Result<Vec<_>, _>>().ok()
    });
    Some(groups.collect::<Option<Vec<_>>>()?.concat())
}

/// The mean distortion of the pieces of both designs, by their length.
fn distortion<'a>(pieces: impl Iterator<Item = &'a Candidate>) -> f64 {
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
