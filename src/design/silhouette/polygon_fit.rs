//! Fits the simplest outline that is consistent with a boundary traced in a picture.
//!
//! A traced boundary has a point on each grid edge that it crosses, with an uncertainty, the slack
//! ([`TracedPoint::slack`]). Stair steps and noise within the slack should not appear in the
//! outline. The fit has two steps:
//! 1. Find the polygons with the fewest chords that pass within the slack of all points (Imai and
//!    Iri 1988, "Polygonal approximations of a curve", with wedges as in Chan and Chin 1996). Fit a
//!    line along each chord, and choose the polygon with the smallest sum of squared distances of
//!    the points from these lines.
//! 2. Move the corners to the intersections of these lines and round them within the slack. Both
//!    follow Selinger 2003 ("Potrace: a polygon-based tracing algorithm"), but with parabolas.

use crate::geometry::{DMat2, DVec2};

/// Point of a traced boundary with its uncertainty.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedPoint {
    /// Position in pixels.
    pub(super) point: DVec2,
    /// Maximum distance of the true boundary from the point, in pixels.
    pub(super) slack: f64,
}

/// Maximum number of points that a chord spans (resource limit: it bounds the work, which is
/// quadratic in this number; a longer line is split into several chords).
const MAX_CHORD_POINTS: usize = 1024;

/// Maximum distance by which a corner is moved from its traced point, in multiples of that point's
/// uncertainty, [`TracedPoint::slack`] (heuristic).
const MAX_CORNER_SHIFT: f64 = 2.0;

/// Sine of the minimum angle between two lines, 30°, at which their intersection is used
/// (tolerance: at smaller angles the intersection is dominated by noise).
const MIN_CORNER_SINE: f64 = 0.5;

/// Minimum length that the rounding of a corner takes from each of its two chords, as a fraction of
/// half the shorter chord. If the rounding would be shorter, the corner counts as intentional and
/// stays sharp (heuristic).
const MIN_ROUNDING: f64 = 0.5;

/// Inserts points so that neighbours are about one pixel apart. This restores the points that
/// contour tracing removes from straight runs.
pub(super) fn densify(boundary: &[TracedPoint]) -> Vec<TracedPoint> {
    let next = boundary.iter().cycle().skip(1);
    let between = |(a, b): (&TracedPoint, &TracedPoint)| {
        let pieces = a.point.distance(b.point).round().max(1.0) as u32;
        let (a, b) = (*a, *b);
        (0..pieces).map(move |k| match k {
            0 => a,
            _ => TracedPoint {
                point: a.point.lerp(b.point, f64::from(k) / f64::from(pieces)),
                slack: a.slack.min(b.slack),
            },
        })
    };
    boundary.iter().zip(next).flat_map(between).collect()
}

/// Fits an outline to a closed boundary. `flatness` is the largest deviation, in pixels, that
/// counts as invisible.
pub(super) fn fit_outline(boundary: &[TracedPoint], flatness: f64) -> Vec<DVec2> {
    if boundary.len() < 4 {
        return boundary.iter().map(|traced| traced.point).collect();
    }
    round_corners(&corners(boundary), flatness)
}

/// Returns the corners of the polygon that fits the boundary with the fewest chords. A line is
/// fitted along each chord, and each corner is moved to the intersection of its two lines.
fn corners(boundary: &[TracedPoint]) -> Vec<TracedPoint> {
    let count = boundary.len();
    let first = sharpest_point(boundary);
    let traced_at = |k: usize| boundary[(first + k) % count];
    let sums = PrefixSums::of((0..=count).map(|k| traced_at(k).point));
    let vertices = fewest_chords(count, &traced_at, &sums);
    let line = |k: usize| {
        let to = vertices.get(k + 1).copied().unwrap_or(count);
        // At least two inner points of the chord are needed to determine a line.
        (to - vertices[k] > 2).then(|| sums.line(vertices[k], to))
    };
    let lines: Vec<Option<FittedLine>> = (0..vertices.len()).map(line).collect();
    let corner = |k: usize| {
        let traced = traced_at(vertices[k]);
        let before = &lines[(k + vertices.len() - 1) % vertices.len()];
        let meeting_point = match (before, &lines[k]) {
            (Some(before), Some(after)) => intersection(before, after),
            _ => None,
        };
        // The shift is clamped, because nearly parallel lines meet far away.
        let shift = meeting_point.map_or(DVec2::ZERO, |met| met - traced.point);
        TracedPoint {
            point: traced.point + shift.clamp_length_max(MAX_CORNER_SHIFT * traced.slack),
            ..traced
        }
    };
    (0..vertices.len()).map(corner).collect()
}

/// Returns the indices of the boundary points that are vertices of the polygon with the fewest
/// chords; each chord must pass every point that it spans within that point's uncertainty,
/// [`TracedPoint::slack`]. Uses dynamic programming along the closed boundary, from the first point
/// back to itself.
fn fewest_chords(
    count: usize,
    traced_at: &dyn Fn(usize) -> TracedPoint,
    sums: &PrefixSums,
) -> Vec<usize> {
    // For each point, the best chain of chords from the first point to it: number of chords, sum of
    // their squared deviations, and start of the last chord.
    let mut best = vec![(usize::MAX, f64::INFINITY, 0); count + 1];
    best[0] = (0, 0.0, 0);
    for from in 0..count {
        let (chords, deviation, _) = best[from];
        let mut wedge = DirectionWedge::at(traced_at(from).point);
        let ahead = best
            .iter_mut()
            .enumerate()
            .skip(from + 1)
            .take(MAX_CHORD_POINTS);
        for (to, best) in ahead {
            if wedge.contains(traced_at(to).point) {
                let deviation = deviation + sums.line(from, to).deviation;
                if (chords + 1, deviation) < (best.0, best.1) {
                    *best = (chords + 1, deviation, from);
                }
            }
            if !wedge.narrow(&traced_at(to)) {
                break;
            }
        }
    }
    let mut vertices = Vec::new();
    let mut k = count;
    while k > 0 {
        k = best[k].2;
        vertices.push(k);
    }
    vertices.reverse();
    vertices
}

/// Returns the index of the point with the largest turning angle, measured over a few points. The
/// polygon starts there, because this point is a vertex of any good polygon.
fn sharpest_point(boundary: &[TracedPoint]) -> usize {
    let count = boundary.len();
    let reach = (count / 4).min(4);
    let turn = |k: &usize| {
        let point = |k: usize| boundary[k % count].point;
        let (incoming, outgoing) = (
            point(*k + reach) - point(*k),
            point(*k + 2 * reach) - point(*k + reach),
        );
        incoming
            .perp_dot(outgoing)
            .atan2(incoming.dot(outgoing))
            .abs()
    };
    let best = (0..count).max_by(|a, b| turn(a).total_cmp(&turn(b)));
    (best.unwrap_or(0) + reach) % count
}

/// Range of the directions in which a chord from the apex passes every point given to
/// [`Self::narrow`] so far within that point's uncertainty, [`TracedPoint::slack`].
struct DirectionWedge {
    apex: DVec2,
    /// Right and left limiting directions; `None` if all directions are allowed.
    sides: Option<[DVec2; 2]>,
}

impl DirectionWedge {
    fn at(apex: DVec2) -> Self {
        Self { apex, sides: None }
    }

    /// Returns whether the direction to a point is in the range.
    fn contains(&self, p: DVec2) -> bool {
        let to = p - self.apex;
        self.sides
            .is_none_or(|[right, left]| right.perp_dot(to) >= 0.0 && to.perp_dot(left) >= 0.0)
    }

    /// Restricts the range to directions in which a chord passes the point `by` within that point's
    /// uncertainty, [`TracedPoint::slack`]; returns whether any direction remains.
    fn narrow(&mut self, by: &TracedPoint) -> bool {
        let to = by.point - self.apex;
        let distance = to.length();
        if distance <= by.slack {
            return true; // every direction passes the point
        }
        let sine = by.slack / distance;
        let cosine = (1.0 - sine * sine).sqrt();
        let right = DVec2::new(cosine, -sine).rotate(to);
        let left = DVec2::new(cosine, sine).rotate(to);
        match &mut self.sides {
            None => self.sides = Some([right, left]),
            Some(sides) => {
                if sides[0].perp_dot(right) > 0.0 {
                    sides[0] = right;
                }
                if left.perp_dot(sides[1]) > 0.0 {
                    sides[1] = left;
                }
                // The range was narrower than half a turn. The cross product of its two limiting
                // directions is therefore negative only if they have passed each other, that is, if
                // the range is empty. The dot product is not positive if the point lies behind the
                // apex.
                return sides[0].perp_dot(sides[1]) >= 0.0 && sides[0].dot(to) > 0.0;
            }
        }
        true
    }
}

/// Total-least-squares line through points.
struct FittedLine {
    /// Centroid of the points.
    centroid: DVec2,
    /// Unit normal of the line.
    normal: DVec2,
    /// Sum of the squared distances of the points from the line.
    deviation: f64,
}

/// Returns the intersection of two lines, or `None` if they are nearly parallel.
fn intersection(a: &FittedLine, b: &FittedLine) -> Option<DVec2> {
    let matrix = DMat2::from_cols(a.normal, b.normal).transpose();
    let offset = b.normal.dot(b.centroid - a.centroid);
    let is_corner = matrix.determinant().abs() > MIN_CORNER_SINE;
    is_corner.then(|| a.centroid + matrix.inverse() * DVec2::new(0.0, offset))
}

/// Prefix sums of coordinates and their products, which give the line through any run of
/// points in constant time.
struct PrefixSums {
    /// Point that is subtracted from all points before they are summed.
    base: DVec2,
    /// Prefix sums of the points.
    linear: Vec<DVec2>,
    /// Prefix sums of x², xy and y².
    products: Vec<[f64; 3]>,
}

impl PrefixSums {
    fn of(points: impl Iterator<Item = DVec2>) -> Self {
        let points: Vec<DVec2> = points.collect();
        // Points are relative to the first one, to avoid cancellation with large coordinates.
        let base = points[0];
        let (mut linear, mut products) = (vec![DVec2::ZERO], vec![[0.0; 3]]);
        let (mut sum, mut product) = (DVec2::ZERO, [0.0; 3]);
        for p in points.iter().map(|&p| p - base) {
            sum += p;
            product[0] += p.x * p.x;
            product[1] += p.x * p.y;
            product[2] += p.y * p.y;
            linear.push(sum);
            products.push(product);
        }
        Self {
            base,
            linear,
            products,
        }
    }

    /// Fits a line to the points `from..=to` of a chord. Excludes the end points, which also belong
    /// to the neighbouring chords, unless fewer than two points would remain.
    fn line(&self, from: usize, to: usize) -> FittedLine {
        let (from, to) = if to - from > 2 {
            (from + 1, to - 1)
        } else {
            (from, to)
        };
        let count = (to + 1 - from) as f64;
        let mean = (self.linear[to + 1] - self.linear[from]) / count;
        let product = |k: usize| self.products[to + 1][k] - self.products[from][k];
        let xx = product(0) - count * mean.x * mean.x;
        let xy = product(1) - count * mean.x * mean.y;
        let yy = product(2) - count * mean.y * mean.y;
        // The line follows the eigenvector of the larger eigenvalue of the covariance.
        let (half, spread) = (0.5 * (xx - yy), 0.5 * (xx + yy));
        let along = DVec2::from_angle(0.5 * xy.atan2(half));
        FittedLine {
            centroid: self.base + mean,
            normal: along.perp(),
            deviation: (spread - half.hypot(xy)).max(0.0),
        }
    }
}

/// Replaces each corner by a parabola whose distance from the corner is at most the corner's
/// uncertainty, [`TracedPoint::slack`]. A corner stays sharp if its parabola would be shorter than
/// [`MIN_ROUNDING`] demands, or if it would pass the corner at a distance of at most `flatness`.
/// Outlines with fewer than four corners are returned unchanged.
fn round_corners(corners: &[TracedPoint], flatness: f64) -> Vec<DVec2> {
    let count = corners.len();
    if count < 4 {
        return corners.iter().map(|corner| corner.point).collect();
    }
    let mut outline = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let p = corner.point;
        let [before, after] = [k + count - 1, k + 1].map(|k| corners[k % count].point - p);
        let [to_before, to_after] = [before.normalize_or_zero(), after.normalize_or_zero()];
        let half = 0.5 * before.length().min(after.length());
        // A parabola replaces the corner. It starts and ends at the distance `reach` from the
        // corner. It passes the corner at the distance 0.25 · `cut` · `reach`, where `cut` is the
        // length of the sum of the unit vectors along the two chords.
        let cut = (to_before + to_after).length();
        let reach = if cut * half > 4.0 * corner.slack {
            4.0 * corner.slack / cut
        } else {
            half
        };
        if reach < MIN_ROUNDING * half || 0.25 * cut * reach <= flatness {
            outline.push(p);
            continue;
        }
        let [a, b] = [p + to_before * reach, p + to_after * reach];
        // A parabola that is divided into n chords (`pieces`) deviates from them by 1/n² of the
        // distance between the corner and the parabola.
        let pieces = (0.25 * cut * reach / flatness.max(1e-9))
            .sqrt()
            .ceil()
            .clamp(1.0, 16.0);
        for k in 0..=pieces as u32 {
            let t = f64::from(k) / pieces;
            let on_curve = a.lerp(p, t).lerp(p.lerp(b, t), t);
            if outline.last() != Some(&on_curve) {
                outline.push(on_curve);
            }
        }
    }
    if outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traced(points: impl Iterator<Item = DVec2>, slack: f64) -> Vec<TracedPoint> {
        points.map(|point| TracedPoint { point, slack }).collect()
    }

    #[test]
    fn corners_between_traced_points_are_reconstructed() {
        // Traced points lie halfway between pixel centres, so none lies at a corner of the square.
        let side =
            |from: DVec2, along: DVec2| (0..20).map(move |k| from + along * (f64::from(k) + 0.5));
        let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(DVec2::from);
        let along = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        let sides = corners.into_iter().zip(along);
        let points = sides.flat_map(|(from, along)| side(from, along));
        let found = fit_outline(&traced(points, 0.5), 0.1);
        assert_eq!(found.len(), 4, "{found:?}");
        for corner in corners {
            assert!(found.iter().any(|p| p.distance(corner) < 1e-9), "{found:?}");
        }
    }

    #[test]
    fn boundaries_without_slack_are_unchanged() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let found = fit_outline(&traced(square.into_iter(), 0.0), 0.1);
        assert_eq!(found.len(), 4);
        assert!(fit_outline(&[], 0.1).is_empty());
    }
}
