//! Finds two edges of closed boundary loops that touch or cross where they must not, by exact
//! predicates.

use crate::geometry::{DVec2, orient2d, segments_touch};
use std::collections::HashSet;

/// Edges of all loops, numbered consecutively. Edge i starts at point i.
struct LoopEdges {
    points: Vec<DVec2>,
    /// For each point, the index of the next point on the same loop.
    next: Vec<usize>,
}

impl LoopEdges {
    /// Numbers the edges of all loops.
    fn of(loops: &[&[DVec2]]) -> Self {
        let mut next = Vec::new();
        for ring in loops {
            let (start, n) = (next.len(), ring.len());
            next.extend((0..n).map(|i| start + (i + 1) % n));
        }
        let points = loops.concat();
        Self { points, next }
    }

    /// Positions of the start and the end of an edge.
    fn ends(&self, edge: usize) -> [DVec2; 2] {
        [self.points[edge], self.points[self.next[edge]]]
    }

    /// Returns whether two edges touch or cross where they must not. Neighbouring edges may share
    /// their common vertex; the two banks of a slit may coincide. If `lenient`, other edges may
    /// share a vertex too.
    fn touch(&self, i: usize, j: usize, lenient: bool) -> bool {
        let ([a, b], [c, d]) = (self.ends(i), self.ends(j));
        // An edge of length zero always counts as touching.
        if a == b || c == d {
            return true;
        }
        // The same edge in both directions is a slit, or a spike if the two edges are neighbours.
        if a == d && b == c {
            return !lenient && (self.next[i] == j || self.next[j] == i);
        }
        let neighbours = self.next[i] == j || self.next[j] == i;
        // Two edges that share a vertex touch elsewhere only if one folds back onto the other.
        if b == c && (neighbours || lenient) {
            return folds_back(a, b, d);
        }
        if a == d && (neighbours || lenient) {
            return folds_back(c, a, b);
        }
        if lenient && a == c {
            return folds_back(b, a, d);
        }
        if lenient && b == d {
            return folds_back(a, b, c);
        }
        segments_touch([a, b], [c, d])
    }
}

/// Returns the indices of two edges that touch or cross where they must not; `None` if there are
/// none. A crossing takes precedence over vertices that coincide without a slit.
pub(super) fn touching_edges(loops: &[&[DVec2]]) -> Option<[usize; 2]> {
    let edges = LoopEdges::of(loops);
    let all: Vec<usize> = (0..edges.next.len()).collect();
    // The lenient sweep comes first. It ignores coinciding vertices, so any crossing is reported
    // before them.
    first_contact(&edges, all, true).or_else(|| {
        // Adding zero turns -0 into 0, so that equal points have equal keys.
        let key = |[a, b]: [DVec2; 2]| [a.x, a.y, b.x, b.y].map(|x| (x + 0.0).to_bits());
        let directed: HashSet<[u64; 4]> =
            (0..edges.next.len()).map(|e| key(edges.ends(e))).collect();
        // An edge lies on a slit if another edge runs back along it.
        let is_slit: Vec<bool> = (0..edges.next.len())
            .map(|e| {
                let [a, b] = edges.ends(e);
                directed.contains(&key([b, a]))
            })
            .collect();
        let is_off_slits = |e: &usize| !is_slit[*e] && !is_slit[edges.next[*e]];
        first_contact(
            &edges,
            (0..is_slit.len()).filter(is_off_slits).collect(),
            false,
        )
    })
}

/// Sweeps along x over the edges in `order` and returns the first two that touch.
fn first_contact(edges: &LoopEdges, mut order: Vec<usize>, lenient: bool) -> Option<[usize; 2]> {
    let left = |i: usize| edges.ends(i)[0].x.min(edges.ends(i)[1].x);
    let right = |i: usize| edges.ends(i)[0].x.max(edges.ends(i)[1].x);
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
    let mut active: Vec<usize> = Vec::new();
    for &i in &order {
        // Edges that end to the left of edge `i` cannot touch it or any later edge.
        active.retain(|&j| right(j) >= left(i));
        if let Some(&j) = active.iter().find(|&&j| edges.touch(i, j, lenient)) {
            return Some([i.min(j), i.max(j)]);
        }
        active.push(i);
    }
    None
}

/// Returns whether the polyline `a`–`b`–`c` runs back over itself or has an edge of length zero.
fn folds_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    a == b || b == c || (orient2d(a, b, c) == 0.0 && (is_between(b, a, c) || is_between(b, c, a)))
}

/// Returns whether `p` lies between `a` and `b` or on one of them; all three must be collinear.
fn is_between(a: DVec2, p: DVec2, b: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all()
}
