//! What is found in fields.

use super::defect_scan;
use super::defect_scan::MomentCounts;
use super::finding::{Finding, FindingCause, FindingKind, Remedy};
use super::remedy;
use crate::content::FieldPair;
use crate::geometry::{DVec2, signed_area};
use crate::transition::Transition;
use crate::work::progress::{Cancelled, Progress};

/// Designs that share less than this have little to do with each other.
/// Half: below, more of the smaller design appears than moves.
const LITTLE_OVERLAP: f64 = 0.5;

/// A trouble by its count, and by the count at the larger end.
type FieldFinding = fn(usize, usize) -> FindingKind;

pub(super) fn findings(
    transition: &Transition,
    pair: &FieldPair,
    glances: &[MomentCounts],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let (Some(first), Some(last)) = (glances.first(), glances.last()) else {
        return Ok(Vec::new());
    };
    let ends = |of: defect_scan::DefectCounts| of(first).max(of(last));
    let mut troubles = Vec::new();
    // Not `worst`: what is wrong here is that a count is too small.
    let gone = defect_scan::times(glances, |g| g.pieces == 0);
    if let (Some(&begin), Some(&end)) = (gone.first(), gone.last())
        && ends(|g| g.pieces) > 0
    {
        troubles.push((FindingKind::Gone, (gone[gone.len() / 2], [begin, end])));
    }
    let counted: [(defect_scan::DefectCounts, FieldFinding); 2] = [
        (
            |g| g.pieces,
            |count, at_ends| FindingKind::Pieces { count, at_ends },
        ),
        (
            |g| g.holes,
            |count, at_ends| FindingKind::Holes { count, at_ends },
        ),
    ];
    for (of, trouble) in counted {
        let at_ends = ends(of);
        if let Some(worst) = defect_scan::worst(glances, of, at_ends) {
            troubles.push((trouble(defect_scan::most(glances, of), at_ends), worst));
        }
    }
    let told = |(trouble, (t, span))| finding(transition, pair, trouble, t, span);
    let mut found: Vec<Finding> = troubles.into_iter().map(told).collect();
    remedy::for_fields(transition, pair, glances.len(), &mut found, progress)?;
    Ok(found)
}

fn finding(
    transition: &Transition,
    pair: &FieldPair,
    trouble: FindingKind,
    t: f64,
    span: [f64; 2],
) -> Finding {
    let share = overlap(pair);
    // Fields that do not overlap vanish and appear whatever the space.
    let (cause, remedy) = if share < LITTLE_OVERLAP {
        (FindingCause::LittleOverlap { share }, Remedy::LayOver)
    } else {
        (FindingCause::BlindFields, Remedy::RigidParts)
    };
    Finding {
        place: place_of(transition, pair, &trouble, t),
        cause,
        remedy,
        trouble,
        t,
        span,
    }
}

/// The middle of the smallest piece or hole, or of the frame.
fn place_of(transition: &Transition, pair: &FieldPair, trouble: &FindingKind, t: f64) -> DVec2 {
    let wanted = if matches!(trouble, FindingKind::Holes { .. }) {
        -1.0
    } else {
        1.0
    };
    let rings = transition.frame(t).figure().rings.into_iter();
    let sized = rings.map(|ring| (wanted * signed_area(&ring), ring));
    let smallest = sized
        .filter(|(area, _)| *area > 0.0)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    smallest.map_or_else(
        || pair.grid().bounds().centre(),
        |(_, ring)| ring.iter().sum::<DVec2>() / ring.len() as f64,
    )
}

/// The share of the smaller design that lies on the other, in cells.
fn overlap(pair: &FieldPair) -> f64 {
    let level = pair.blend().threshold;
    let is_inside = |value: &f32| f64::from(*value) >= level;
    let (mut source, mut target, mut both) = (0_usize, 0_usize, 0_usize);
    for (a, b) in pair.source().values().iter().zip(pair.target().values()) {
        let (a, b) = (is_inside(a), is_inside(b));
        source += usize::from(a);
        target += usize::from(b);
        both += usize::from(a && b);
    }
    both as f64 / source.min(target).max(1) as f64
}
