//! Leaves out the points of polygons that no one would miss: those that at every
//! moment lie on the straight line between others (Douglas, Peucker 1973, with the
//! farthest of all moments for the distance).
//!
//! Outlines that were matched have points along their straight sides and dense ones
//! along their curves; a film that leaves needs only what is seen.

use std::ops::Range;
use std::sync::Arc;

use crate::geometry::DVec2;

use super::chebyshev;
use super::piece::AnimationPiece;
use super::shape::{PathVerb, ShapeForm};

/// How far a point that is left out may be from the line that takes its place, in
/// pixels: a fifth of what all steps may be together.
const MISSED_PX: f64 = 0.04;

/// The same where a shape does not move, and nothing else adds to it.
pub(super) const STATIC_TOLERANCE_PX: f64 = 0.04;

/// Moments of a piece that are looked at.
const MOMENTS: usize = 8;

/// Thins all shapes, those that go on from piece to piece alike; what does not move up
/// to a tolerance of its own.
pub(super) fn simplify(pieces: &mut [AnimationPiece], still_px: f64) {
    let mut from = 0;
    while from < pieces.len() {
        let rest = pieces[from + 1..].iter();
        let to = from + 1 + rest.take_while(|piece| piece.goes_on).count();
        let scene = &mut pieces[from..to];
        for k in 0..scene[0].shapes.len() {
            thin_shape(scene, k, still_px);
        }
        from = to;
    }
}

/// Thins one shape over all pieces of a scene.
fn thin_shape(scene: &mut [AnimationPiece], k: usize, still_px: f64) {
    let verbs = match &*scene[0].shapes[k].first.form {
        ShapeForm::Fill { verbs, .. } | ShapeForm::Line { verbs, .. } => verbs,
        ShapeForm::Bars | ShapeForm::Discs => return,
    };
    let moments = moments(scene, k);
    let missed = if moments.len() > 1 {
        MISSED_PX
    } else {
        still_px
    };
    let mut kept_verbs = Vec::new();
    let mut kept: Vec<usize> = Vec::new();
    let mut first = 0;
    for ring in verbs.split_inclusive(|verb| *verb == PathVerb::Close) {
        let count = ring.iter().map(|verb| verb.points()).sum::<usize>();
        let points = first..first + count;
        first += count;
        let inner = ring
            .get(1..ring.len().saturating_sub(1))
            .unwrap_or_default();
        if count < 4 || !inner.iter().all(|verb| *verb == PathVerb::Line) {
            kept_verbs.extend_from_slice(ring);
            kept.extend(points);
            continue;
        }
        let of_ring = kept_of(&moments, points, missed);
        kept_verbs.push(PathVerb::Move);
        kept_verbs.extend(vec![PathVerb::Line; of_ring.len() - 1]);
        kept_verbs.push(PathVerb::Close);
        kept.extend(of_ring);
    }
    let form = Arc::new(match &*scene[0].shapes[k].first.form {
        ShapeForm::Fill { label, ramp, .. } => ShapeForm::Fill {
            verbs: kept_verbs,
            label: label.clone(),
            ramp: *ramp,
        },
        ShapeForm::Line { join, .. } => ShapeForm::Line {
            verbs: kept_verbs,
            join: *join,
        },
        ShapeForm::Bars | ShapeForm::Discs => return,
    });
    for piece in scene {
        let shape = &mut piece.shapes[k];
        let thinned = |points: &Vec<DVec2>| kept.iter().map(|&i| points[i]).collect();
        shape.first.form = form.clone();
        shape.first.points = thinned(&shape.first.points);
        shape.terms = shape.terms.iter().map(thinned).collect();
    }
}

/// Where the points of a shape are at some moments of all pieces.
fn moments(scene: &[AnimationPiece], k: usize) -> Vec<Vec<DVec2>> {
    let of_piece = |piece: &AnimationPiece| {
        let terms = piece.shapes[k].terms.clone();
        let count = if terms.len() > 1 { MOMENTS } else { 0 };
        let at = move |m: usize| chebyshev::evaluate(&terms, m as f64 / count.max(1) as f64);
        (0..=count).map(at)
    };
    scene.iter().flat_map(of_piece).collect()
}

/// The points of a ring that are kept, ascending; at least three.
fn kept_of(moments: &[Vec<DVec2>], ring: Range<usize>, missed: f64) -> Vec<usize> {
    // The ring is open at its first point and at the one that is farthest from it.
    let far = |&i: &usize| {
        let away = moments.iter().map(|m| m[i].distance_squared(m[ring.start]));
        away.sum::<f64>()
    };
    let between = ring.start + 1..ring.end;
    let farthest = between.max_by(|a, b| far(a).total_cmp(&far(b)));
    let farthest = farthest.unwrap_or(ring.start);
    let mut kept = vec![ring.start, farthest];
    let mut walks = vec![(ring.start, farthest), (farthest, ring.end)];
    while let Some((a, b)) = walks.pop() {
        let end = if b == ring.end { ring.start } else { b };
        let off = |&i: &usize| {
            let off = moments.iter().map(|m| off_line(m[i], m[a], m[end]));
            off.fold(0.0, f64::max)
        };
        let Some(i) = (a + 1..b).max_by(|a, b| off(a).total_cmp(&off(b))) else {
            continue;
        };
        if off(&i) > missed {
            kept.push(i);
            walks.extend([(a, i), (i, b)]);
        }
    }
    if kept.len() < 3 {
        // A ring that is a line, or nothing: as it is.
        return ring.collect();
    }
    kept.sort_unstable();
    kept
}

/// How far a point is from the line between two.
fn off_line(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let s = if length > 0.0 {
        ((p - a).dot(along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a + s * along)
}
