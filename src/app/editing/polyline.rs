//! Geometry of closed polylines: nearest points, corners, inside tests, arc-length positions.
//!
//! Rings are lists of points, closed from the last to the first. Distances are measured in the
//! frame that both designs are placed in.

use crate::geometry::{DVec2, nearest_segment_parameter};

/// Minimum turning angle, in radians, at a vertex that counts as a corner for pins to snap to; the
/// vertices of flattened curves turn less (heuristic).
const MIN_CORNER_TURN: f64 = 0.44;

/// The nearest point on a set of rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestRingPoint {
    /// Index of the ring that contains the point.
    pub ring: usize,
    /// Index of the edge that contains the point: the index of the vertex at which the edge starts.
    pub edge: usize,
    /// Position of the point along the edge, from 0 to 1.
    pub along: f64,
    /// The nearest point itself.
    pub point: DVec2,
    /// Distance of the point from the query point.
    pub distance: f64,
}

/// Returns the point nearest to `p` on any of the rings; `None` if there are no edges.
pub fn nearest<'a>(rings: impl Iterator<Item = &'a [DVec2]>, p: DVec2) -> Option<NearestRingPoint> {
    let mut best: Option<NearestRingPoint> = None;
    for (ring, points) in rings.enumerate() {
        for edge in 0..points.len() {
            let (a, b) = (points[edge], points[(edge + 1) % points.len()]);
            let along = nearest_segment_parameter(p, a, b);
            let point = a.lerp(b, along);
            let distance = point.distance(p);
            if best.is_none_or(|best| distance < best.distance) {
                best = Some(NearestRingPoint {
                    ring,
                    edge,
                    along,
                    point,
                    distance,
                });
            }
        }
    }
    best
}

/// Whether a point lies inside the rings by the even–odd rule.
pub fn encloses<'a>(rings: impl Iterator<Item = &'a [DVec2]>, p: DVec2) -> bool {
    crossings(rings, p.y).filter(|x| *x > p.x).count() % 2 == 1
}

/// Intervals of x in which the horizontal line at `y` lies inside the rings, from left to right.
pub fn inside_intervals<'a>(rings: impl Iterator<Item = &'a [DVec2]>, y: f64) -> Vec<[f64; 2]> {
    let mut xs: Vec<f64> = crossings(rings, y).collect();
    xs.sort_by(f64::total_cmp);
    // Closed rings cross a line an even number of times: in, out, in, out.
    xs.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Values of x at which edges of the rings cross the horizontal line at `y`.
fn crossings<'a>(rings: impl Iterator<Item = &'a [DVec2]>, y: f64) -> impl Iterator<Item = f64> {
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    edges
        // The interval is half-open, so a vertex at this height counts once. Horizontal edges,
        // which would divide by zero below, are excluded.
        .filter(move |(a, b)| (a.y > y) != (b.y > y))
        .map(move |(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
}

/// A point for a label inside the rings: the middle of the widest horizontal interval, near middle
/// height, that no shape in `above` covers. `None` if these shapes cover everything.
pub fn label_point(rings: &[&[DVec2]], above: &[&[Vec<DVec2>]]) -> Option<DVec2> {
    let ys = || rings.iter().flat_map(|ring| ring.iter().map(|p| p.y));
    let low = ys().reduce(f64::min)?;
    let high = ys().reduce(f64::max)?;
    let widest = |shares: &[f64]| {
        let free_intervals = shares.iter().flat_map(|share| {
            let y = low + share * (high - low);
            let mut remaining = inside_intervals(rings.iter().copied(), y);
            for cover in above {
                for covered in inside_intervals(cover.iter().map(Vec::as_slice), y) {
                    remaining = subtract(remaining, covered);
                }
            }
            remaining
                .into_iter()
                .map(move |[a, b]| (b - a, DVec2::new(0.5 * (a + b), y)))
        });
        free_intervals
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, at)| at)
    };
    // Five heights are compared, because the middle may run along an edge or through a hole. If
    // nothing is free at these heights, the shape is nearly covered, and more heights are tried.
    let dense_shares: [f64; 31] = std::array::from_fn(|k| (k + 1) as f64 / 32.0);
    widest(&[0.5, 0.4, 0.6, 0.25, 0.75]).or_else(|| widest(&dense_shares))
}

/// Returns the sections of `intervals` that lie outside the interval from `from` to `to`.
fn subtract(intervals: Vec<[f64; 2]>, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let remainders = |[a, b]: [f64; 2]| [[a, b.min(from)], [a.max(to), b]];
    let remainders = intervals.into_iter().flat_map(remainders);
    remainders.filter(|[a, b]| a < b).collect()
}

/// Vertices of a ring that count as corners for pins to snap to.
pub fn corners(points: &[DVec2]) -> Vec<DVec2> {
    let n = points.len();
    (0..n)
        .filter(|&k| {
            let (before, here, after) = (points[(k + n - 1) % n], points[k], points[(k + 1) % n]);
            turning_angle(here - before, after - here).abs() > MIN_CORNER_TURN
        })
        .map(|k| points[k])
        .collect()
}

/// Angle from one direction to another, in (−π, π]; 0 if either vector is zero.
pub fn turning_angle(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

/// Returns the arc-length position of each vertex, and the length of the ring. Positions are
/// fractions of this length; the first vertex is at 0.
pub fn arc_length_positions(points: &[DVec2]) -> (Vec<f64>, f64) {
    let mut places = Vec::with_capacity(points.len());
    let mut length = 0.0;
    for (k, p) in points.iter().enumerate() {
        places.push(length);
        length += p.distance(points[(k + 1) % points.len()]);
    }
    if length > 0.0 {
        places.iter_mut().for_each(|place| *place /= length);
    }
    (places, length)
}

/// The point of a ring at the arc-length position `place`, a fraction that wraps round. `places`
/// are the positions of the vertices.
///
/// # Panics
/// If there are no points.
pub fn point_at(points: &[DVec2], places: &[f64], place: f64) -> DVec2 {
    let place = place.rem_euclid(1.0);
    let next = places.partition_point(|p| *p <= place);
    // The first vertex is at 0, so there is always a vertex at or before `place`.
    let k = next.saturating_sub(1);
    let end = places.get(next).copied().unwrap_or(1.0);
    let gap = end - places[k];
    let along = if gap > 0.0 {
        (place - places[k]) / gap
    } else {
        0.0
    };
    points[k].lerp(points[(k + 1) % points.len()], along)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec2> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
            .map(DVec2::from)
            .to_vec()
    }

    fn hole() -> Vec<DVec2> {
        [(0.5, 0.5), (0.5, 1.5), (1.0, 1.5), (1.0, 0.5)]
            .map(DVec2::from)
            .to_vec()
    }

    #[test]
    fn the_foot_is_the_nearest_point() {
        let ring = square();
        let foot = nearest([ring.as_slice()].into_iter(), DVec2::new(3.0, 0.5)).expect("a foot");
        assert_eq!((foot.edge, foot.along, foot.distance), (1, 0.25, 1.0));
        assert_eq!(foot.point, DVec2::new(2.0, 0.5));
        assert_eq!(nearest([].into_iter(), DVec2::ZERO), None);
    }

    #[test]
    fn holes_are_outside() {
        let (ring, hole) = (square(), hole());
        let rings = || [ring.as_slice(), hole.as_slice()].into_iter();
        assert!(encloses(rings(), DVec2::new(0.25, 1.0)));
        assert!(!encloses(rings(), DVec2::new(0.75, 1.0)));
        assert!(!encloses(rings(), DVec2::new(3.0, 1.0)));
        assert_eq!(inside_intervals(rings(), 1.0), [[0.0, 0.5], [1.0, 2.0]]);
        let at = label_point(&[&ring, &hole], &[]).expect("a place");
        assert!(encloses(rings(), at));
    }

    #[test]
    fn a_label_avoids_covered_heights() {
        let square = square();
        let cover = |from: f64, to: f64| {
            let corners = [(0.0, from), (2.0, from), (2.0, to), (0.0, to)];
            vec![corners.map(DVec2::from).to_vec()]
        };
        let [low, middle, high] = [cover(0.0, 0.4), cover(0.3, 1.6), cover(1.7, 2.0)];
        let at = label_point(&[&square], &[&middle]).expect("a place");
        assert!(!(0.3..=1.6).contains(&at.y), "{at}");
        let at = label_point(&[&square], &[&low, &middle, &high]).expect("a place");
        assert!((1.6..=1.7).contains(&at.y), "{at}");
        assert_eq!(label_point(&[&square], &[&cover(0.0, 2.0)]), None);
        let left = vec![vec![
            DVec2::ZERO,
            DVec2::new(1.5, 0.0),
            DVec2::new(1.5, 2.0),
            DVec2::new(0.0, 2.0),
        ]];
        assert_eq!(label_point(&[&square], &[&left]).map(|at| at.x), Some(1.75));
    }

    #[test]
    fn corners_are_where_a_ring_turns() {
        assert_eq!(corners(&square()).len(), 4);
        let round: Vec<DVec2> = (0..64)
            .map(|k| DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 64.0))
            .collect();
        assert!(corners(&round).is_empty());
    }

    #[test]
    fn places_and_points_are_each_others_way_back() {
        let ring = square();
        let (places, length) = arc_length_positions(&ring);
        assert_eq!(length, 8.0);
        assert_eq!(places, [0.0, 0.25, 0.5, 0.75]);
        assert_eq!(point_at(&ring, &places, 0.375), DVec2::new(2.0, 1.0));
        assert_eq!(point_at(&ring, &places, -0.125), DVec2::new(0.0, 1.0));
        assert_eq!(point_at(&ring, &places, 1.0), DVec2::ZERO);
    }
}
