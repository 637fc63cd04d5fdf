//! The plainest outline that the pixels of a picture leave open.
//!
//! A traced boundary has a point on each lattice edge that it crosses, known
//! only so well: [`Traced::slack`]. What is between, stairs and noise, is
//! nobody's drawing. First the fewest chords from point to point that leave no
//! point farther than its slack (Imai and Iri 1988, "Polygonal approximations of
//! a curve", with wedges as Chan and Chin 1996), of these the ones nearest to the
//! points. Then the corners of those chords that no pixel shows are rounded, as
//! Selinger 2003 ("Potrace: a polygon-based tracing algorithm") does, here with
//! parabolas and as far as the slack goes.

use crate::geometry::DVec2;

/// A point of a traced boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Traced {
    pub(super) point: DVec2,
    /// How far from it the boundary may run, in pixels.
    pub(super) slack: f64,
}

/// A chord spans so many points at most: what bounds the work. Two chords
/// along one line are as good as one.
const LONGEST: usize = 1024;

/// Where rounding reaches less than this share of half of the shorter chord, a
/// corner was drawn.
const ROUND: f64 = 0.5;

/// The outline of a closed boundary; `flatness` is how far off nobody sees, in
/// pixels.
pub(super) fn fitted(boundary: &[Traced], flatness: f64) -> Vec<DVec2> {
    if boundary.len() < 4 {
        return boundary.iter().map(|traced| traced.point).collect();
    }
    rounded(&fewest_chords(boundary), flatness)
}

/// The points between which the fewest chords run.
fn fewest_chords(boundary: &[Traced]) -> Vec<Traced> {
    let count = boundary.len();
    let first = sharpest(boundary);
    let at = |k: usize| boundary[(first + k) % count];
    let sums = Sums::of((0..=count).map(|k| at(k).point));
    // The fewest chords from the first point to each, how far off they are, and
    // where the last of them begins.
    let mut best = vec![(usize::MAX, f64::INFINITY, 0); count + 1];
    best[0] = (0, 0.0, 0);
    for from in 0..count {
        let (chords, off, _) = best[from];
        let mut wedge = Wedge::at(at(from).point);
        for to in from + 1..=count.min(from + LONGEST) {
            if wedge.reaches(at(to).point) {
                let off = off + sums.off(from, to);
                if (chords + 1, off) < (best[to].0, best[to].1) {
                    best[to] = (chords + 1, off, from);
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
        kept.push(at(k));
    }
    kept.reverse();
    kept
}

/// The point at which the boundary turns most, seen over a few points: a
/// vertex of any outline.
fn sharpest(boundary: &[Traced]) -> usize {
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
struct Wedge {
    apex: DVec2,
    /// Its right and its left side, where anything has narrowed it.
    sides: Option<[DVec2; 2]>,
}

impl Wedge {
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
    fn narrow(&mut self, by: &Traced) -> bool {
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

/// Sums of coordinates and of their products, from which it follows how far
/// points are from a chord.
struct Sums {
    points: Vec<DVec2>,
    linear: Vec<DVec2>,
    /// Of x², xy and y².
    products: Vec<[f64; 3]>,
}

impl Sums {
    fn of(points: impl Iterator<Item = DVec2>) -> Self {
        let points: Vec<DVec2> = points.collect();
        // About the first: large coordinates lose their digits.
        let base = points[0];
        let points: Vec<DVec2> = points.iter().map(|&p| p - base).collect();
        let (mut linear, mut products) = (vec![DVec2::ZERO], vec![[0.0; 3]]);
        let (mut sum, mut product) = (DVec2::ZERO, [0.0; 3]);
        for p in &points {
            sum += *p;
            product[0] += p.x * p.x;
            product[1] += p.x * p.y;
            product[2] += p.y * p.y;
            linear.push(sum);
            products.push(product);
        }
        Self {
            points,
            linear,
            products,
        }
    }

    /// Σ of the squared distances of the points of a chord from its line.
    fn off(&self, from: usize, to: usize) -> f64 {
        let (a, b) = (self.points[from], self.points[to]);
        let Some(normal) = (b - a).perp().try_normalize() else {
            return 0.0;
        };
        let count = (to + 1 - from) as f64;
        let sum = self.linear[to + 1] - self.linear[from];
        let [xx, xy, yy] = [0, 1, 2].map(|k| self.products[to + 1][k] - self.products[from][k]);
        let offset = normal.dot(a);
        let squares =
            normal.x * normal.x * xx + 2.0 * normal.x * normal.y * xy + normal.y * normal.y * yy;
        (squares - 2.0 * offset * normal.dot(sum) + count * offset * offset).max(0.0)
    }
}

/// The polygon with those of its corners rounded that no pixel shows.
fn rounded(corners: &[Traced], flatness: f64) -> Vec<DVec2> {
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

    fn traced(points: impl Iterator<Item = DVec2>, slack: f64) -> Vec<Traced> {
        points.map(|point| Traced { point, slack }).collect()
    }

    #[test]
    fn stairs_become_straight_sides_and_corners_stay() {
        // A slope of one in five and back along straight sides, as pixels show it.
        let stairs = (0..100).map(|x| DVec2::new(f64::from(x), f64::from(x / 5)));
        let right = (20..100).map(|y| DVec2::new(100.0, f64::from(y)));
        let top = (0..100).map(|x| DVec2::new(100.0 - f64::from(x), 100.0));
        let left = (1..100).map(|y| DVec2::new(0.0, f64::from(100 - y)));
        let outline = fitted(
            &traced(stairs.chain(right).chain(top).chain(left), 0.5),
            0.1,
        );
        assert!(outline.len() <= 8, "{outline:?}");
        for corner in [(100.0, 100.0), (0.0, 100.0)] {
            let far = outline.iter().map(|p| p.distance(DVec2::from(corner)));
            assert!(far.fold(f64::INFINITY, f64::min) < 1.5, "{outline:?}");
        }
    }

    #[test]
    fn a_circle_of_pixels_is_round() {
        let circle = (0..720).map(|k| {
            let p = 100.0 * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 720.0);
            p.round()
        });
        let outline = fitted(&traced(circle, 0.5), 0.1);
        assert!(outline.len() < 120);
        let turn = |k: usize| {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| outline[k % outline.len()]);
            (b - a).angle_to(c - b).abs()
        };
        let sharpest = (0..outline.len()).map(turn).fold(0.0, f64::max);
        assert!(sharpest < 0.2, "{sharpest}");
        for p in &outline {
            assert!((p.length() - 100.0).abs() < 1.1, "{p}");
        }
    }

    #[test]
    fn what_has_no_room_stays() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let found = fitted(&traced(square.into_iter(), 0.0), 0.1);
        assert_eq!(found.len(), 4);
        assert!(fitted(&[], 0.1).is_empty());
    }
}
