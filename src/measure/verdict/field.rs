//! Finds the defects of blends of distance fields: extra pieces or holes, and shapes that disappear
//! at some t between 0 and 1.

use super::defect_scan;
use super::defect_scan::MomentCounts;
use super::finding::{Finding, FindingCause, FindingKind, Remedy};
use super::remedy;
use crate::content::FieldPair;
use crate::geometry::{DVec2, signed_area};
use crate::transition::Transition;
use crate::work::progress::{Cancelled, Progress};

/// If the two designs overlap by less than this fraction of the smaller design's area, the lack of
/// overlap is named as the cause (heuristic).
const LITTLE_OVERLAP: f64 = 0.5;

/// Function that creates the kind of a finding from two counts: the largest at any t, and the
/// larger of those at t = 0 and t = 1.
type FieldFinding = fn(usize, usize) -> FindingKind;

/// Finds when the contour of a blend of distance fields disappears or has extra pieces or holes.
/// Also tests whether there are fewer of these defects on the other scale of distances (linear
/// instead of logarithmic, or the reverse).
pub(super) fn field_findings(
    transition: &Transition,
    pair: &FieldPair,
    moments: &[MomentCounts],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let (Some(first), Some(last)) = (moments.first(), moments.last()) else {
        return Ok(Vec::new());
    };
    let ends = |of: defect_scan::DefectCounts| of(first).max(of(last));
    let mut defects = Vec::new();
    // `worst_moment` finds counts that are too large, but here the number of pieces is too small.
    let absent = defect_scan::times_where(moments, |g| g.pieces == 0);
    if let (Some(&begin), Some(&end)) = (absent.first(), absent.last())
        && ends(|g| g.pieces) > 0
    {
        defects.push((FindingKind::Gone, (absent[absent.len() / 2], [begin, end])));
    }
    let counters: [(defect_scan::DefectCounts, FieldFinding); 2] = [
        (
            |g| g.pieces,
            |count, at_ends| FindingKind::Pieces { count, at_ends },
        ),
        (
            |g| g.holes,
            |count, at_ends| FindingKind::Holes { count, at_ends },
        ),
    ];
    for (of, kind) in counters {
        let at_ends = ends(of);
        if let Some(worst) = defect_scan::worst_moment(moments, of, at_ends) {
            defects.push((kind(defect_scan::max_count(moments, of), at_ends), worst));
        }
    }
    let describe = |(trouble, (t, span))| finding(transition, pair, trouble, t, span);
    let mut findings: Vec<Finding> = defects.into_iter().map(describe).collect();
    remedy::try_other_blend_space(transition, pair, moments.len(), &mut findings, progress)?;
    Ok(findings)
}

/// Describes a defect of a field with its place, cause and remedy.
fn finding(
    transition: &Transition,
    pair: &FieldPair,
    trouble: FindingKind,
    t: f64,
    span: [f64; 2],
) -> Finding {
    let overlap_fraction = overlap(pair);
    // If the designs hardly overlap, this is named as the cause. The scale of distances is not the
    // cause then, because shapes disappear and appear on either scale, linear or logarithmic.
    let (cause, remedy) = if overlap_fraction < LITTLE_OVERLAP {
        (
            FindingCause::LittleOverlap {
                share: overlap_fraction,
            },
            Remedy::LayOver,
        )
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

/// Returns the centre of the smallest piece at `t`, or of the smallest hole if the defect is extra
/// holes. If there is no such piece or hole, returns the centre of the grid.
fn place_of(transition: &Transition, pair: &FieldPair, trouble: &FindingKind, t: f64) -> DVec2 {
    let orientation = if matches!(trouble, FindingKind::Holes { .. }) {
        -1.0
    } else {
        1.0
    };
    let rings = transition.frame(t).figure().rings.into_iter();
    let rings_with_area = rings.map(|ring| (orientation * signed_area(&ring), ring));
    let smallest = rings_with_area
        .filter(|(area, _)| *area > 0.0)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    smallest.map_or_else(
        || pair.grid().bounds().centre(),
        |(_, ring)| ring.iter().sum::<DVec2>() / ring.len() as f64,
    )
}

/// Returns the area common to both designs as a fraction of the smaller design's area, counted in
/// grid cells.
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
