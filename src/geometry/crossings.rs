//! Finds the proper crossings of closed polygons with themselves and with each other.
//!
//! The algorithm is a sweep over the edges along x or y, whichever axis has fewer overlapping edges
//! (Shamos, Hoey 1976, without their tree of active edges). It takes O(n log n + k) time for n
//! edges of which k pairs overlap along that axis. Guaranteed: every proper crossing is found, by
//! exact predicates. Not counted: touching edges, coincident edges, and edges that run exactly
//! through a vertex.

use super::{DVec2, orient2d, segments_cross};
use serde::Serialize;

/// Edge of a closed polygon, from a point to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RingEdge {
    /// Index of the ring in the list of rings.
    pub ring: usize,
    /// Index in the ring of the point at which the edge starts.
    pub point: usize,
}

/// Crossing of two edges at a point inside both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeCrossing {
    /// The two edges, ordered by ring and point.
    pub edges: [RingEdge; 2],
    /// Point at which the edges cross, up to rounding.
    pub place: DVec2,
}

/// Returns the number of proper crossings among the edges of all rings, within a ring and between
/// rings.
///
/// ```
/// use morphospace::geometry::{DVec2, count_crossings};
/// let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from).to_vec();
/// assert_eq!(count_crossings(&[bow]), 1);
/// ```
#[must_use]
pub fn count_crossings(rings: &[Vec<DVec2>]) -> usize {
    let mut count = 0;
    sweep(rings, |_, _| count += 1);
    count
}

/// Returns the proper crossings among the edges of all rings, within a ring and between rings. They
/// are sorted by their first edge, then by their second.
///
/// ```
/// use morphospace::geometry::{DVec2, crossings};
/// let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from).to_vec();
/// assert_eq!(crossings(&[bow])[0].place, DVec2::splat(0.5));
/// ```
#[must_use]
pub fn crossings(rings: &[Vec<DVec2>]) -> Vec<EdgeCrossing> {
    let mut found = Vec::new();
    sweep(rings, |a, b| found.push(crossing(rings, a, b)));
    let key = |c: &EdgeCrossing| c.edges.map(|e| (e.ring, e.point));
    found.sort_unstable_by_key(key);
    found
}

/// Edge with its extents along and across the sweep direction.
#[derive(Clone, Copy)]
struct SweepEdge {
    /// Smallest and largest coordinate along the sweep.
    along: [f64; 2],
    /// Smallest and largest coordinate across the sweep.
    across: [f64; 2],
    edge: RingEdge,
    ends: [DVec2; 2],
}

/// Calls `report` for each pair of edges that cross.
fn sweep(rings: &[Vec<DVec2>], mut report: impl FnMut(RingEdge, RingEdge)) {
    let mut spans = spans(rings);
    // NaN does no harm: `total_cmp` sorts it to an end, and `<=` is false for it.
    spans.sort_unstable_by(|a, b| a.along[0].total_cmp(&b.along[0]));
    for (i, span) in spans.iter().enumerate() {
        let later = spans[i + 1..].iter();
        // The edges are sorted by their starts, so the first one that starts beyond the end of this
        // edge ends the search.
        for other in later.take_while(|other| other.along[0] <= span.along[1]) {
            let is_apart = other.across[0] > span.across[1] || span.across[0] > other.across[1];
            if !is_apart && segments_cross(span.ends, other.ends) {
                report(span.edge, other.edge);
            }
        }
    }
}

/// Returns the edges of all rings. The range `along` of each edge is on the axis, x or y, on which
/// fewer edges overlap.
fn spans(rings: &[Vec<DVec2>]) -> Vec<SweepEdge> {
    let sorted = |a: f64, b: f64| [a.min(b), a.max(b)];
    let mut spans: Vec<SweepEdge> = ring_edges(rings)
        .map(|(edge, ends)| SweepEdge {
            along: sorted(ends[0].x, ends[1].x),
            across: sorted(ends[0].y, ends[1].y),
            edge,
            ends,
        })
        .collect();
    // Returns the mean number of edges that overlap at a point of an axis.
    let overlap = |of: fn(&SweepEdge) -> [f64; 2]| {
        let all = spans.iter().map(of);
        let (mut sum, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for [a, b] in all {
            (sum, low, high) = (sum + (b - a), f64::min(low, a), f64::max(high, b));
        }
        sum / (high - low)
    };
    // The time of the sweep grows with the overlap along its axis, so sweep along the axis with
    // less overlap.
    if overlap(|s| s.along) > overlap(|s| s.across) {
        for span in &mut spans {
            std::mem::swap(&mut span.along, &mut span.across);
        }
    }
    spans
}

/// Returns the edges of all rings with their ends.
fn ring_edges(rings: &[Vec<DVec2>]) -> impl Iterator<Item = (RingEdge, [DVec2; 2])> {
    rings.iter().enumerate().flat_map(|(ring, points)| {
        let next = points.iter().cycle().skip(1);
        let ends = points.iter().zip(next).map(|(&a, &b)| [a, b]);
        ends.enumerate()
            .map(move |(point, ends)| (RingEdge { ring, point }, ends))
    })
}

/// Returns the crossing of two edges that are known to cross.
fn crossing(rings: &[Vec<DVec2>], a: RingEdge, b: RingEdge) -> EdgeCrossing {
    let ends = |e: RingEdge| {
        let ring = &rings[e.ring];
        [ring[e.point], ring[(e.point + 1) % ring.len()]]
    };
    let ([p, q], [r, s]) = (ends(a), ends(b));
    // The signed heights of p and q over the line from r to s give the fraction of the way from p
    // to q at which the edges cross.
    let (height_p, height_q) = (orient2d(r, s, p), orient2d(r, s, q));
    let mut edges = [a, b];
    edges.sort_unstable_by_key(|e| (e.ring, e.point));
    EdgeCrossing {
        edges,
        place: p.lerp(q, height_p / (height_p - height_q)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the number of crossings by testing all pairs of edges (slow oracle).
    fn slow_count(rings: &[Vec<DVec2>]) -> usize {
        let edges: Vec<_> = ring_edges(rings).collect();
        let pairs = (0..edges.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs
            .filter(|&(i, j)| segments_cross(edges[i].1, edges[j].1))
            .count()
    }

    fn rings() -> impl Strategy<Value = Vec<Vec<DVec2>>> {
        let point = (-8i8..8, -8i8..8, 0.0f64..0.5)
            .prop_map(|(x, y, off)| DVec2::new(f64::from(x) + off, f64::from(y)));
        prop::collection::vec(prop::collection::vec(point, 0..12), 0..4)
    }

    proptest! {
        #[test]
        fn the_sweep_finds_what_trying_all_pairs_finds(rings in rings()) {
            prop_assert_eq!(count_crossings(&rings), slow_count(&rings));
            let found = crossings(&rings);
            prop_assert_eq!(found.len(), slow_count(&rings));
            for crossing in &found {
                prop_assert!(crossing.place.abs().max_element() <= 8.5);
            }
        }
    }

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        [(low, low), (high, low), (high, high), (low, high)]
            .map(DVec2::from)
            .to_vec()
    }

    #[test]
    fn different_rings_cross_each_other() {
        let found = crossings(&[square(0.0, 2.0), square(1.0, 3.0)]);
        let places: Vec<_> = found.iter().map(|c| c.place).collect();
        assert_eq!(places, [DVec2::new(2.0, 1.0), DVec2::new(1.0, 2.0)]);
        assert_eq!(found[0].edges.map(|e| (e.ring, e.point)), [(0, 1), (1, 0)]);
    }

    #[test]
    fn touching_and_lying_on_each_other_are_no_crossings() {
        assert_eq!(count_crossings(&[square(0.0, 1.0), square(1.0, 2.0)]), 0);
        assert_eq!(count_crossings(&[square(0.0, 1.0), square(0.0, 1.0)]), 0);
    }

    #[test]
    fn edges_that_are_not_finite_cross_nothing() {
        let mut ring = square(0.0, 1.0);
        ring[2] = DVec2::NAN;
        assert_eq!(count_crossings(&[ring, square(0.2, 0.4), vec![]]), 0);
    }
}
