//! Counts defects of outlines before they are cleaned: crossings, touches, duplicates, outlines
//! without area, and idle points. An idle point repeats the previous point or lies straight between
//! its neighbours, so the outline has the same shape without it.
//!
//! This module also removes duplicates, outlines without area and idle points. It only counts
//! crossings and touches; they are resolved by [`Regions`](super::Regions).
//!
//! Edges are compared by a sweep along x (Shamos and Hoey 1976, with a list instead of their tree
//! of active edges) and exact predicates. The sweep may make 500 comparisons per edge; if that is
//! not enough, the counts are lower bounds and [`Repairs::at_least`] is set.
//!
//! A contact at a corner of both edges is not counted, because outlines may touch that way.

use super::{Bounds, DVec2, orient2d, ring_edges};
use std::collections::HashSet;

/// Numbers of defects that cleaning repaired.
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
    /// Number of pairs of edges that cross at a point inside both.
    pub crossings: usize,
    /// Number of corners that lie on another edge, not at its ends.
    pub touches: usize,
    /// Whether there may be more crossings and touches than were counted.
    pub at_least: bool,
    /// Number of outlines with the same points as an earlier one; they are left out.
    pub duplicates: usize,
    /// Number of outlines that enclose nothing, because they have fewer than three different points
    /// or all points lie on one line.
    pub flat: usize,
    /// Number of regions and holes that were removed because they are too small or too thin.
    /// Cleaning leaves such slivers where edges touch or almost touch.
    pub slivers: usize,
    /// Number of points that repeat the previous point, or lie straight between their neighbours.
    pub idle_points: usize,
}

/// Maximum number of comparisons in the sweep, divided by the number of edges (resource limit: two
/// million edges take seconds, and up to 1,000 edges are always compared in full).
const TESTS_PER_EDGE: usize = 500;

impl Repairs {
    /// Returns the sums of these counts and those of another set of outlines.
    #[must_use]
    pub fn merged_with(self, other: Self) -> Self {
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

    /// Returns the rings to be cleaned, and the defects found. Leaves out rings that enclose
    /// nothing, duplicate rings and points that change nothing. All coordinates must be in range.
    pub(super) fn find(rings: &[Vec<DVec2>]) -> (Vec<Vec<DVec2>>, Self) {
        let mut repairs = Self::default();
        let mut seen = HashSet::new();
        let mut used_rings = Vec::new();
        for ring in rings {
            let (corners, idle) = corners(ring);
            // Leave out rings that enclose nothing before the search for duplicates: without
            // corners, all of them look alike.
            if corners.len() < 3 {
                repairs.flat += 1;
                continue;
            }
            if !seen.insert(fingerprint(&corners)) {
                repairs.duplicates += 1;
                continue;
            }
            repairs.idle_points += idle;
            used_rings.push(corners);
        }
        repairs.cross(&used_rings);
        (used_rings, repairs)
    }

    /// Counts only crossings and touches, also those of duplicate rings and of rings that enclose
    /// nothing.
    #[must_use]
    pub fn count_contacts(rings: &[Vec<DVec2>]) -> Self {
        let mut repairs = Self::default();
        repairs.cross(rings);
        repairs
    }

    /// Counts crossings and touches by a sweep along x.
    fn cross(&mut self, rings: &[Vec<DVec2>]) {
        let mut edges: Vec<BoxedEdge> = rings
            .iter()
            .flat_map(|ring| ring_edges(ring))
            .map(|(a, b)| BoxedEdge::new(a, b))
            .collect();
        edges.sort_unstable_by(|e, f| e.bounds.min.x.total_cmp(&f.bounds.min.x));
        let mut tests = TESTS_PER_EDGE * edges.len();
        let mut active: Vec<BoxedEdge> = Vec::new();
        for edge in edges {
            // Edges that end before this one begins cannot meet it.
            active.retain(|other| other.bounds.max.x >= edge.bounds.min.x);
            // Give up if too many edges overlap along x, as in combs and hatchings.
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

    /// Adds the crossing and the touches of two edges, if there are any, to the counts.
    fn compare(&mut self, e: &BoxedEdge, f: &BoxedEdge) {
        // The sweep compares x only. Edges that are apart in y need no exact predicates.
        if e.bounds.min.y > f.bounds.max.y || f.bounds.min.y > e.bounds.max.y {
            return;
        }
        let [ea, eb] = [orient2d(f.a, f.b, e.a), orient2d(f.a, f.b, e.b)];
        let [fa, fb] = [orient2d(e.a, e.b, f.a), orient2d(e.a, e.b, f.b)];
        if have_opposite_signs(ea, eb) && have_opposite_signs(fa, fb) {
            self.crossings += 1;
        }
        // Test only the edges' start points: an end point is the start of the next edge.
        self.touches += usize::from(ea == 0.0 && f.has_inside(e.a));
        self.touches += usize::from(fa == 0.0 && e.has_inside(f.a));
    }
}

/// Returns whether one number is positive and the other negative.
fn have_opposite_signs(a: f64, b: f64) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

#[derive(Clone, Copy)]
struct BoxedEdge {
    a: DVec2,
    b: DVec2,
    bounds: Bounds,
}

impl BoxedEdge {
    fn new(a: DVec2, b: DVec2) -> Self {
        let bounds = Bounds::at(a).union(&Bounds::at(b));
        Self { a, b, bounds }
    }

    /// Returns whether a point, which must lie on the edge's line, lies strictly between the edge's
    /// ends.
    fn has_inside(&self, p: DVec2) -> bool {
        self.bounds.contains(p) && p != self.a && p != self.b
    }
}

/// Returns the points at which a ring turns, and the number of idle points, which change nothing;
/// no points if the ring encloses nothing. A repetition of the first point at the end is not
/// counted as idle, because some formats close rings that way.
fn corners(ring: &[DVec2]) -> (Vec<DVec2>, usize) {
    let mut points = ring.to_vec();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    // Points are counted only now, so that the closing point, which was removed above, does not
    // count as idle. All points that are removed below do.
    let given_count = points.len();
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
        // A reversal of direction counts as a turn: the fill rule decides whether such a spike
        // encloses anything.
        orient2d(a, b, c) != 0.0 || (b - a).dot(c - b) < 0.0
    };
    let corners: Vec<DVec2> = (0..count).filter(turns).map(|i| points[i]).collect();
    if is_flat(&corners) {
        return (Vec::new(), 0);
    }
    let idle = given_count - corners.len();
    (corners, idle)
}

/// Returns whether all points lie on one line.
fn is_flat(points: &[DVec2]) -> bool {
    let Some(&first) = points.first() else {
        return true;
    };
    // The farthest point differs from the first one if any point does.
    let far = |p: &&DVec2| p.distance_squared(first);
    let farthest = points.iter().max_by(|p, q| far(p).total_cmp(&far(q)));
    farthest.is_none_or(|&end| points.iter().all(|&p| orient2d(first, end, p) == 0.0))
}

/// Returns a list that is the same for two rings through the same points, whichever point they
/// start at and whichever way they run. Rings that pass their smallest point more than eight times
/// may get different lists.
fn fingerprint(ring: &[DVec2]) -> Vec<[u64; 2]> {
    let bits = |p: &DVec2| [p.x + 0.0, p.y + 0.0].map(f64::to_bits); // -0 + 0 is 0
    let forward: Vec<[u64; 2]> = ring.iter().map(bits).collect();
    let backward = forward.iter().rev().copied().collect();
    smallest_rotation(forward).min(smallest_rotation(backward))
}

/// Rotates a list so that it starts at its smallest element. If that element occurs several times,
/// takes the lexicographically smallest of the first eight possible rotations.
fn smallest_rotation(mut list: Vec<[u64; 2]>) -> Vec<[u64; 2]> {
    let least = list.iter().min().copied();
    let starts = (0..list.len()).filter(|&i| Some(list[i]) == least);
    // A ring may pass its smallest point many times; to compare a few rotations is enough.
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
        // Two squares that touch in a corner need no repair.
        let other_square = ring(&[(4, 4), (8, 4), (8, 8), (4, 8)]);
        assert_eq!(repairs(&[ring(&SQUARE), other_square]), Repairs::default());
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
        let found = Repairs::count_contacts(&[comb(false), comb(true)]);
        assert!(found.at_least && found.crossings > 1_000);
    }
}
