//! Removes superfluous polygon points of animated shapes. A point is superfluous if at every moment
//! it lies close to the line between the remaining points before and after it (Douglas and Peucker
//! 1973, with the largest distance over all moments).
//!
//! Matched outlines have extra points on straight sides and dense points along curves; an exported
//! film needs only those that are visible.

use std::ops::Range;
use std::sync::Arc;

use crate::geometry::DVec2;

use super::chebyshev;
use super::piece::AnimationPiece;
use super::shape::{PathVerb, ShapeForm};

/// Maximum distance of a removed point of a moving shape from the line that replaces it, in pixels
/// (tolerance: a fifth of `VectorAnimation::TOLERANCE_PX`).
const TOLERANCE_PX: f64 = 0.04;

/// Maximum distance of a removed point of a static shape from the line that replaces it, in pixels
/// (tolerance: as for moving shapes, although no interpolation error adds to it).
pub(super) const STATIC_TOLERANCE_PX: f64 = 0.04;

/// Number of equal intervals into which a moving animation piece is divided. Distances are measured
/// at the ends of these intervals (resource limit: the time to simplify is proportional to it).
const MOMENTS_PER_PIECE: usize = 8;

/// Simplifies all shapes. Consecutive animation pieces with the same shapes lose the same points.
/// Shapes that do not move are simplified with the tolerance `still_px`.
pub(super) fn simplify(pieces: &mut [AnimationPiece], still_px: f64) {
    let mut from = 0;
    while from < pieces.len() {
        let rest = pieces[from + 1..].iter();
        let to = from + 1 + rest.take_while(|piece| piece.is_continuation).count();
        let scene = &mut pieces[from..to];
        for k in 0..scene[0].shapes.len() {
            simplify_shape(scene, k, still_px);
        }
        from = to;
    }
}

/// Simplifies the shape with index `k` in all pieces of a scene (consecutive animation pieces with
/// the same shapes).
fn simplify_shape(scene: &mut [AnimationPiece], k: usize, still_px: f64) {
    let verbs = match &*scene[0].shapes[k].first.form {
        ShapeForm::Fill { verbs, .. } | ShapeForm::Stroke { verbs, .. } => verbs,
        ShapeForm::Bars | ShapeForm::Discs => return,
    };
    let moments = moments(scene, k);
    let tolerance = if moments.len() > 1 {
        TOLERANCE_PX
    } else {
        still_px
    };
    let mut new_verbs = Vec::new();
    let mut indices: Vec<usize> = Vec::new();
    let mut first = 0;
    for ring in verbs.split_inclusive(|verb| *verb == PathVerb::Close) {
        let count = ring.iter().map(|verb| verb.point_count()).sum::<usize>();
        let points = first..first + count;
        first += count;
        let inner = ring
            .get(1..ring.len().saturating_sub(1))
            .unwrap_or_default();
        // Only polygons with more than three corners can be simplified; others are copied.
        if count < 4 || !inner.iter().all(|verb| *verb == PathVerb::Line) {
            new_verbs.extend_from_slice(ring);
            indices.extend(points);
            continue;
        }
        let ring_indices = indices_to_keep(&moments, points, tolerance);
        new_verbs.push(PathVerb::Move);
        new_verbs.extend(vec![PathVerb::Line; ring_indices.len() - 1]);
        new_verbs.push(PathVerb::Close);
        indices.extend(ring_indices);
    }
    let form = Arc::new(match &*scene[0].shapes[k].first.form {
        ShapeForm::Fill { label, ramp, .. } => ShapeForm::Fill {
            verbs: new_verbs,
            label: label.clone(),
            ramp: *ramp,
        },
        ShapeForm::Stroke { join, .. } => ShapeForm::Stroke {
            verbs: new_verbs,
            join: *join,
        },
        ShapeForm::Bars | ShapeForm::Discs => return,
    });
    for piece in scene {
        let shape = &mut piece.shapes[k];
        let thinned = |points: &Vec<DVec2>| indices.iter().map(|&i| points[i]).collect();
        shape.first.form = form.clone();
        shape.first.points = thinned(&shape.first.points);
        shape.terms = shape.terms.iter().map(thinned).collect();
    }
}

/// Returns the positions of a shape's points at sampled moments of all animation pieces in `scene`.
fn moments(scene: &[AnimationPiece], k: usize) -> Vec<Vec<DVec2>> {
    let of_piece = |piece: &AnimationPiece| {
        let terms = piece.shapes[k].terms.clone();
        let count = if terms.len() > 1 {
            MOMENTS_PER_PIECE
        } else {
            0
        };
        let at = move |m: usize| chebyshev::evaluate(&terms, m as f64 / count.max(1) as f64);
        (0..=count).map(at)
    };
    scene.iter().flat_map(of_piece).collect()
}

/// Returns the indices of the points of the closed polygon `ring` that remain, in ascending order.
/// At least three remain.
fn indices_to_keep(moments: &[Vec<DVec2>], ring: Range<usize>, tolerance: f64) -> Vec<usize> {
    // The polygon is split at its first point and at the point farthest from that point.
    let distance = |&i: &usize| {
        let squares = moments.iter().map(|m| m[i].distance_squared(m[ring.start]));
        squares.sum::<f64>()
    };
    let between = ring.start + 1..ring.end;
    let farthest = between.max_by(|a, b| distance(a).total_cmp(&distance(b)));
    let farthest = farthest.unwrap_or(ring.start);
    let mut indices = vec![ring.start, farthest];
    let mut chains = vec![(ring.start, farthest), (farthest, ring.end)];
    while let Some((a, b)) = chains.pop() {
        let end = if b == ring.end { ring.start } else { b };
        let deviation = |&i: &usize| {
            let distances = moments
                .iter()
                .map(|m| distance_to_segment(m[i], m[a], m[end]));
            distances.fold(0.0, f64::max)
        };
        let Some(i) = (a + 1..b).max_by(|a, b| deviation(a).total_cmp(&deviation(b))) else {
            continue;
        };
        if deviation(&i) > tolerance {
            indices.push(i);
            chains.extend([(a, i), (i, b)]);
        }
    }
    if indices.len() < 3 {
        // A degenerate polygon (a line or a point) keeps all its points.
        return ring.collect();
    }
    indices.sort_unstable();
    indices
}

/// Returns the distance of a point from a line segment.
fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let s = if length > 0.0 {
        ((p - a).dot(along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a + s * along)
}
