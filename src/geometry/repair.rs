//! What is wrong with outlines before they are cleaned: crossings, touches,
//! outlines drawn twice or without area, points that say nothing.
//!
//! Edges are compared by a sweep along x (Shamos and Hoey 1976, with a list
//! in place of the tree) and exact predicates. The sweep has a budget of
//! 500 comparisons for each edge; where that is spent the
//! counts are lower bounds, and [`Repairs::at_least`] says so.
//!
//! Not counted: edges that meet in corners of both. Outlines may touch so.

use super::{Bounds, DVec2, orient2d, ring_edges};
use std::collections::HashSet;

/// What cleaning had to repair.
///
/// ```
/// use morphospace::geometry::{DVec2, FillRule, Regions};
/// let bow = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)].map(DVec2::from).to_vec();
/// let (regions, repairs) = Regions::from_rings_reporting(&[bow], FillRule::EvenOdd)?;
/// assert_eq!((regions.len(), repairs.crossings), (2, 1));
/// # Ok::<(), morphospace::geometry::RegionsError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Pairs of edges that cross inside both.
    pub crossings: usize,
    /// Corners that lie on another edge.
    pub touches: usize,
    /// Whether there may be more crossings and touches than were counted.
    pub at_least: bool,
    /// Outlines with the same points as an earlier one, all but one left out.
    pub duplicates: usize,
    /// Outlines that enclose nothing: fewer than three different points, or
    /// all on one line.
    pub flat: usize,
    /// Pieces and holes too small to count, left over from touching edges.
    pub slivers: usize,
    /// Points that repeat the one before or lie straight between their
    /// neighbours.
    pub idle_points: usize,
}

/// Comparisons that the sweep may spend on each edge: up to that many edges
/// are compared in full however they lie, and two million edges take no more
/// than seconds.
const TESTS_PER_EDGE: usize = 500;

impl Repairs {
    /// The faults of this and another set of outlines together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            crossings: self.crossings + other.crossings,
            touches: self.touches + other.touches,
            at_least: self.at_least || other.at_least,
            duplicates: self.duplicates + other.duplicates,
            flat: self.flat + other.flat,
            slivers: self.slivers + other.slivers,
            idle_points: self.idle_points + other.idle_points,
        }
    }

    /// What is wrong with rings of points in range, and the rings to be cleaned:
    /// those that enclose something, each once.
    pub(super) fn find(rings: &[Vec<DVec2>]) -> (Vec<Vec<DVec2>>, Self) {
        let mut found = Self::default();
        let mut seen = HashSet::new();
        let mut kept = Vec::new();
        for ring in rings {
            let (corners, idle) = corners(ring);
            // Before the duplicates: flat rings have no corners, all alike.
            if corners.len() < 3 {
                found.flat += 1;
                continue;
            }
            if !seen.insert(fingerprint(&corners)) {
                found.duplicates += 1;
                continue;
            }
            found.idle_points += idle;
            kept.push(corners);
        }
        found.cross(&kept);
        (kept, found)
    }

    /// Counts crossings and touches only; the rings are taken as they are.
    #[must_use]
    pub fn between(rings: &[Vec<DVec2>]) -> Self {
        let mut found = Self::default();
        found.cross(rings);
        found
    }

    fn cross(&mut self, rings: &[Vec<DVec2>]) {
        let mut edges: Vec<BoxedEdge> = rings
            .iter()
            .flat_map(|ring| ring_edges(ring))
            .map(BoxedEdge::new)
            .collect();
        edges.sort_unstable_by(|e, f| e.bounds.min.x.total_cmp(&f.bounds.min.x));
        let mut tests = TESTS_PER_EDGE * edges.len();
        let mut active: Vec<BoxedEdge> = Vec::new();
        for edge in edges {
            active.retain(|other| other.bounds.max.x >= edge.bounds.min.x);
            // Combs and hatchings stand beside each other all along the sweep.
            if active.len() > tests {
                self.at_least = true;
                return;
            }
            tests -= active.len();
            for other in &active {
                self.compare(&edge, other);
            }
            active.push(edge);
        }
    }

    fn compare(&mut self, e: &BoxedEdge, f: &BoxedEdge) {
        if e.bounds.min.y > f.bounds.max.y || f.bounds.min.y > e.bounds.max.y {
            return;
        }
        let [ea, eb] = [orient2d(f.a, f.b, e.a), orient2d(f.a, f.b, e.b)];
        let [fa, fb] = [orient2d(e.a, e.b, f.a), orient2d(e.a, e.b, f.b)];
        if differ(ea, eb) && differ(fa, fb) {
            self.crossings += 1;
        }
        // First ends only: a last end is the first of the edge after it.
        self.touches += usize::from(ea == 0.0 && f.holds_inside(e.a));
        self.touches += usize::from(fa == 0.0 && e.holds_inside(f.a));
    }
}

fn differ(a: f64, b: f64) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

#[derive(Clone, Copy)]
struct BoxedEdge {
    a: DVec2,
    b: DVec2,
    bounds: Bounds,
}

impl BoxedEdge {
    fn new((a, b): (DVec2, DVec2)) -> Self {
        let bounds = Bounds::at(a).union(&Bounds::at(b));
        Self { a, b, bounds }
    }

    /// Whether a point of the edge's line lies between its ends.
    fn holds_inside(&self, p: DVec2) -> bool {
        self.bounds.contains(p) && p != self.a && p != self.b
    }
}

/// The points at which the ring turns, and how many others there are. The
/// first point, repeated at the end, is only how some formats close a ring.
fn corners(ring: &[DVec2]) -> (Vec<DVec2>, usize) {
    let mut points = ring.to_vec();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    // A closing point is nobody's fault; whatever else goes is idle.
    let given = points.len();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let count = points.len();
    let turns = |&i: &usize| {
        let (a, b, c) = (
            points[(i + count - 1) % count],
            points[i],
            points[(i + 1) % count],
        );
        // Straight back is a turn: what it holds is for the fill rule.
        orient2d(a, b, c) != 0.0 || (b - a).dot(c - b) < 0.0
    };
    let corners: Vec<DVec2> = (0..count).filter(turns).map(|i| points[i]).collect();
    if is_flat(&corners) {
        return (Vec::new(), 0);
    }
    let idle = given - corners.len();
    (corners, idle)
}

fn is_flat(points: &[DVec2]) -> bool {
    let Some(&first) = points.first() else {
        return true;
    };
    // The farthest is another place than the first if any point is.
    let far = |p: &&DVec2| p.distance_squared(first);
    let farthest = points.iter().max_by(|p, q| far(p).total_cmp(&far(q)));
    farthest.is_none_or(|&end| points.iter().all(|&p| orient2d(first, end, p) == 0.0))
}

/// The same for two rings exactly when they run through the same points,
/// wherever they start and whichever way they run.
fn fingerprint(ring: &[DVec2]) -> Vec<[u64; 2]> {
    let bits = |p: &DVec2| [p.x + 0.0, p.y + 0.0].map(f64::to_bits); // -0 is 0
    let forward: Vec<[u64; 2]> = ring.iter().map(bits).collect();
    let backward = forward.iter().rev().copied().collect();
    from_least(forward).min(from_least(backward))
}

/// The list turned so that it is the least of all its turns, as far as its
/// least elements tell.
fn from_least(mut list: Vec<[u64; 2]>) -> Vec<[u64; 2]> {
    let least = list.iter().min().copied();
    let starts = (0..list.len()).filter(|&i| Some(list[i]) == least);
    // A point that the ring runs through many times: a few turns will do.
    let turned = |i: usize| list[i..].iter().chain(&list[..i]);
    if let Some(best) = starts.take(8).min_by(|&i, &j| turned(i).cmp(turned(j))) {
        list.rotate_left(best);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{FillRule, Regions};

    fn ring(points: &[(i32, i32)]) -> Vec<DVec2> {
        points
            .iter()
            .map(|&(x, y)| DVec2::new(x.into(), y.into()))
            .collect()
    }

    fn repairs(rings: &[Vec<DVec2>]) -> Repairs {
        Regions::from_rings_reporting(rings, FillRule::EvenOdd)
            .expect("area")
            .1
    }

    const SQUARE: [(i32, i32); 4] = [(0, 0), (4, 0), (4, 4), (0, 4)];

    #[test]
    fn clean_outlines_need_no_repair() {
        let hole = ring(&[(1, 1), (3, 1), (2, 3)]);
        let closed: Vec<_> = SQUARE.iter().copied().chain([(0, 0)]).collect();
        for rings in [
            vec![ring(&SQUARE)],
            vec![ring(&SQUARE), hole],
            vec![ring(&closed)],
        ] {
            assert_eq!(repairs(&rings), Repairs::default());
        }
        // Two squares that touch in a corner.
        let beside = ring(&[(4, 4), (8, 4), (8, 8), (4, 8)]);
        assert_eq!(repairs(&[ring(&SQUARE), beside]), Repairs::default());
    }

    #[test]
    fn each_fault_is_counted() {
        let star = ring(&[(0, 30), (18, -24), (-29, 9), (29, 9), (-18, -24)]);
        assert_eq!(repairs(&[star]).crossings, 5);
        let touching = ring(&[(4, 1), (6, 0), (6, 2)]);
        assert_eq!(repairs(&[ring(&SQUARE), touching]).touches, 1);
        let mut turned = ring(&SQUARE);
        turned.rotate_left(2);
        turned.reverse();
        assert_eq!(repairs(&[ring(&SQUARE), turned]).duplicates, 1);
        let line = ring(&[(9, 9), (10, 10), (12, 12), (11, 11)]);
        assert_eq!(repairs(&[ring(&SQUARE), line, ring(&[(9, 9)])]).flat, 2);
        let idle = ring(&[(0, 0), (0, 0), (2, 0), (4, 0), (4, 4), (0, 4)]);
        assert_eq!(repairs(&[idle]).idle_points, 2);
    }

    #[test]
    fn duplicates_do_not_cancel() {
        let twice = [ring(&SQUARE), ring(&SQUARE)];
        let (regions, _) = Regions::from_rings_reporting(&twice, FillRule::EvenOdd).expect("area");
        assert!((regions.area() - 16.0).abs() < 1e-9);
    }

    #[test]
    fn a_spike_is_left_to_the_fill_rule() {
        let spike = ring(&[(0, 0), (4, 0), (9, 0), (4, 0), (4, 4), (0, 4)]);
        let (regions, repairs) =
            Regions::from_rings_reporting(&[spike], FillRule::NonZero).expect("area");
        assert!((regions.area() - 16.0).abs() < 1e-9);
        assert_ne!(repairs, Repairs::default());
    }

    #[test]
    fn dense_crossings_end_with_a_lower_bound() {
        // Every edge of the one comb crosses every edge of the other.
        let comb = |turn: bool| -> Vec<DVec2> {
            (0..4000)
                .map(|k| {
                    let (along, across) = (f64::from(k), f64::from(4000 * (k % 2)));
                    DVec2::new(along, across)
                })
                .map(|p| if turn { DVec2::new(p.y, p.x) } else { p })
                .collect()
        };
        let found = Repairs::between(&[comb(false), comb(true)]);
        assert!(found.at_least && found.crossings > 1_000);
    }
}
