//! The plainest outline that the pixels of a picture leave open.
//!
//! A traced boundary has a point on each lattice edge that it crosses, known
//! only so well: [`TracedPoint::slack`]. What is between, stairs and noise, is
//! nobody's drawing. First the fewest chords from point to point that leave no
//! point farther than its slack (Imai and Iri 1988, "Polygonal approximations of
//! a curve", with wedges as Chan and Chin 1996), of these the ones whose points
//! lie best on lines. Then corners where those lines meet, and what no pixel shows
//! of them rounded, both as Selinger 2003 ("Potrace: a polygon-based tracing
//! algorithm") does, here with parabolas and as far as the slack goes.

use crate::geometry::{DMat2, DVec2};

/// A point of a traced boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedPoint {
    pub(super) point: DVec2,
    /// How far from it the boundary may run, in pixels.
    pub(super) slack: f64,
}

/// A chord spans so many points at most: what bounds the work. Two chords
/// along one line are as good as one.
const LONGEST: usize = 1024;

/// A corner may be so many times the slack from the point that was traced there:
/// between pixels that of a square lies one pixel from each.
const FARTHEST: f64 = 2.0;

/// The sine of the angle from which on lines meet in a corner, a twelfth of a
/// turn: where it is less, where they meet is noise.
const CORNER: f64 = 0.5;

/// Where rounding reaches less than this share of half of the shorter chord, a
/// corner was drawn.
const ROUND: f64 = 0.5;

/// A boundary of which no two neighbours are much farther apart than a pixel, as
/// it was before points on straight runs were left out.
pub(super) fn resampled(boundary: &[TracedPoint]) -> Vec<TracedPoint> {
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

/// The outline of a closed boundary; `flatness` is how far off nobody sees, in
/// pixels.
pub(super) fn fit_outline(boundary: &[TracedPoint], flatness: f64) -> Vec<DVec2> {
    if boundary.len() < 4 {
        return boundary.iter().map(|traced| traced.point).collect();
    }
    rounded(&corners(boundary), flatness)
}

/// Where the lines along the fewest chords meet.
fn corners(boundary: &[TracedPoint]) -> Vec<TracedPoint> {
    let count = boundary.len();
    let first = sharpest(boundary);
    let at = |k: usize| boundary[(first + k) % count];
    let sums = PrefixSums::of((0..=count).map(|k| at(k).point));
    let kept = fewest_chords(count, &at, &sums);
    let line = |k: usize| {
        let to = kept.get(k + 1).copied().unwrap_or(count);
        // Of fewer points within a line says nothing.
        (to - kept[k] > 2).then(|| sums.line(kept[k], to))
    };
    let lines: Vec<Option<FittedLine>> = (0..kept.len()).map(line).collect();
    let corner = |k: usize| {
        let traced = at(kept[k]);
        let before = &lines[(k + kept.len() - 1) % kept.len()];
        let met = match (before, &lines[k]) {
            (Some(before), Some(after)) => met(before, after),
            _ => None,
        };
        // Where lines hardly cross they meet far away.
        let by = met.map_or(DVec2::ZERO, |met| met - traced.point);
        TracedPoint {
            point: traced.point + by.clamp_length_max(FARTHEST * traced.slack),
            ..traced
        }
    };
    (0..kept.len()).map(corner).collect()
}

/// The numbers of the points between which the fewest chords run.
fn fewest_chords(count: usize, at: &dyn Fn(usize) -> TracedPoint, sums: &PrefixSums) -> Vec<usize> {
    // The fewest chords from the first point to each, how far off they are, and
    // where the last of them begins.
    let mut best = vec![(usize::MAX, f64::INFINITY, 0); count + 1];
    best[0] = (0, 0.0, 0);
    for from in 0..count {
        let (chords, off, _) = best[from];
        let mut wedge = DirectionWedge::at(at(from).point);
        let ahead = best.iter_mut().enumerate().skip(from + 1).take(LONGEST);
        for (to, best) in ahead {
            if wedge.reaches(at(to).point) {
                let off = off + sums.line(from, to).off;
                if (chords + 1, off) < (best.0, best.1) {
                    *best = (chords + 1, off, from);
                }
            }
            if !wedge.narrow(&at(to)) {
                break;
            }
        }
    }
    let mut kept = Vec::new();
    let mut k = count;
    while k > 0 {
        k = best[k].2;
        kept.push(k);
    }
    kept.reverse();
    kept
}

/// The point at which the boundary turns most, seen over a few points: a
/// vertex of any outline.
fn sharpest(boundary: &[TracedPoint]) -> usize {
    let count = boundary.len();
    let reach = (count / 4).min(4);
    let turn = |k: &usize| {
        let at = |k: usize| boundary[k % count].point;
        let (come, go) = (at(*k + reach) - at(*k), at(*k + 2 * reach) - at(*k + reach));
        come.perp_dot(go).atan2(come.dot(go)).abs()
    };
    let best = (0..count).max_by(|a, b| turn(a).total_cmp(&turn(b)));
    (best.unwrap_or(0) + reach) % count
}

/// The directions from a point in which a chord passes all points so far
/// within their slack.
struct DirectionWedge {
    apex: DVec2,
    /// Its right and its left side, where anything has narrowed it.
    sides: Option<[DVec2; 2]>,
}

impl DirectionWedge {
    fn at(apex: DVec2) -> Self {
        Self { apex, sides: None }
    }

    fn reaches(&self, p: DVec2) -> bool {
        let to = p - self.apex;
        self.sides
            .is_none_or(|[right, left]| right.perp_dot(to) >= 0.0 && to.perp_dot(left) >= 0.0)
    }

    /// Only the directions in which this one is passed within its slack are
    /// left; whether any is.
    fn narrow(&mut self, by: &TracedPoint) -> bool {
        let to = by.point - self.apex;
        let far = to.length();
        if far <= by.slack {
            return true; // in all directions
        }
        let sine = by.slack / far;
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
                // A wedge is less than half a turn wide.
                return sides[0].perp_dot(sides[1]) >= 0.0 && sides[0].dot(to) > 0.0;
            }
        }
        true
    }
}

/// A line through the middle of some points.
struct FittedLine {
    through: DVec2,
    normal: DVec2,
    /// Σ of the squared distances of the points from it.
    off: f64,
}

/// The place where two lines meet, if in a corner.
fn met(a: &FittedLine, b: &FittedLine) -> Option<DVec2> {
    let matrix = DMat2::from_cols(a.normal, b.normal).transpose();
    let away = b.normal.dot(b.through - a.through);
    let is_corner = matrix.determinant().abs() > CORNER;
    is_corner.then(|| a.through + matrix.inverse() * DVec2::new(0.0, away))
}

/// Sums of coordinates and of their products, from which the line through points
/// follows.
struct PrefixSums {
    base: DVec2,
    linear: Vec<DVec2>,
    /// Of x², xy and y².
    products: Vec<[f64; 3]>,
}

impl PrefixSums {
    fn of(points: impl Iterator<Item = DVec2>) -> Self {
        let points: Vec<DVec2> = points.collect();
        // About the first: large coordinates lose their digits.
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

    /// The line from which the points of a chord are least off, its ends left
    /// out: they belong to the next chord as well.
    fn line(&self, from: usize, to: usize) -> FittedLine {
        let (from, to) = if to - from > 2 {
            (from + 1, to - 1)
        } else {
            (from, to)
        };
        let count = (to + 1 - from) as f64;
        let middle = (self.linear[to + 1] - self.linear[from]) / count;
        let product = |k: usize| self.products[to + 1][k] - self.products[from][k];
        let xx = product(0) - count * middle.x * middle.x;
        let xy = product(1) - count * middle.x * middle.y;
        let yy = product(2) - count * middle.y * middle.y;
        // The eigenvector of the larger eigenvalue runs along.
        let (half, spread) = (0.5 * (xx - yy), 0.5 * (xx + yy));
        let along = DVec2::from_angle(0.5 * xy.atan2(half));
        FittedLine {
            through: self.base + middle,
            normal: along.perp(),
            off: (spread - half.hypot(xy)).max(0.0),
        }
    }
}

/// The polygon with those of its corners rounded that no pixel shows.
fn rounded(corners: &[TracedPoint], flatness: f64) -> Vec<DVec2> {
    let count = corners.len();
    if count < 4 {
        return corners.iter().map(|corner| corner.point).collect();
    }
    let mut outline = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let at = corner.point;
        let [before, after] = [k + count - 1, k + 1].map(|k| corners[k % count].point - at);
        let [come, go] = [before.normalize_or_zero(), after.normalize_or_zero()];
        let half = 0.5 * before.length().min(after.length());
        // A parabola from as far on both sides cuts a quarter of this off.
        let cut = (come + go).length();
        let reach = if cut * half > 4.0 * corner.slack {
            4.0 * corner.slack / cut
        } else {
            half
        };
        if reach < ROUND * half || 0.25 * cut * reach <= flatness {
            outline.push(at);
            continue;
        }
        let [a, b] = [at + come * reach, at + go * reach];
        // Of a parabola in n pieces a chord is off by a quarter of that by n².
        let pieces = (0.25 * cut * reach / flatness.max(1e-9))
            .sqrt()
            .ceil()
            .clamp(1.0, 16.0);
        for k in 0..=pieces as u32 {
            let t = f64::from(k) / pieces;
            let p = a.lerp(at, t).lerp(at.lerp(b, t), t);
            if outline.last() != Some(&p) {
                outline.push(p);
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
    fn a_rectangle_has_its_corners_though_none_was_traced() {
        // As it is crossed between pixels: halfway between their middles.
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
    fn what_has_no_room_stays() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let found = fit_outline(&traced(square.into_iter(), 0.0), 0.1);
        assert_eq!(found.len(), 4);
        assert!(fit_outline(&[], 0.1).is_empty());
    }
}
