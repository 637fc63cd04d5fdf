//! Where closed walks touch themselves or each other, exactly.

use crate::geometry::{DVec2, orient2d, segments_touch};
use std::collections::HashSet;

/// The walks' edges, numbered through.
struct LoopEdges {
    points: Vec<DVec2>,
    /// For each corner the next one of its walk.
    next: Vec<usize>,
}

impl LoopEdges {
    fn of(walks: &[&[DVec2]]) -> Self {
        let mut next = Vec::new();
        for walk in walks {
            let (start, n) = (next.len(), walk.len());
            next.extend((0..n).map(|i| start + (i + 1) % n));
        }
        let points = walks.concat();
        Self { points, next }
    }

    fn ends(&self, edge: usize) -> [DVec2; 2] {
        [self.points[edge], self.points[self.next[edge]]]
    }

    /// Whether two edges share more than they may: neighbours a vertex, the
    /// banks of a slit everything, others a vertex if `lenient`.
    fn touch(&self, i: usize, j: usize, lenient: bool) -> bool {
        let ([a, b], [c, d]) = (self.ends(i), self.ends(j));
        if a == b || c == d {
            return true;
        }
        if a == d && b == c {
            return !lenient && (self.next[i] == j || self.next[j] == i);
        }
        let neighbours = self.next[i] == j || self.next[j] == i;
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

/// Two edges that touch where they must not, by a sweep along x. Crossings
/// come first, then points that meet beside no slit.
pub(super) fn touching_edges(walks: &[&[DVec2]]) -> Option<[usize; 2]> {
    let edges = LoopEdges::of(walks);
    let all: Vec<usize> = (0..edges.next.len()).collect();
    // Lenient first: where vertices meet is passed over, so that what crosses
    // is named before it.
    found(&edges, all, true).or_else(|| {
        // Negative zero is zero.
        let key = |[a, b]: [DVec2; 2]| [a.x, a.y, b.x, b.y].map(|x| (x + 0.0).to_bits());
        let walked: HashSet<[u64; 4]> = (0..edges.next.len()).map(|e| key(edges.ends(e))).collect();
        let slit: Vec<bool> = (0..edges.next.len())
            .map(|e| {
                let [a, b] = edges.ends(e);
                walked.contains(&key([b, a]))
            })
            .collect();
        let beside = |e: &usize| !slit[*e] && !slit[edges.next[*e]];
        found(&edges, (0..slit.len()).filter(beside).collect(), false)
    })
}

fn found(edges: &LoopEdges, mut order: Vec<usize>, lenient: bool) -> Option<[usize; 2]> {
    let left = |i: usize| edges.ends(i)[0].x.min(edges.ends(i)[1].x);
    let right = |i: usize| edges.ends(i)[0].x.max(edges.ends(i)[1].x);
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
    let mut active: Vec<usize> = Vec::new();
    for &i in &order {
        active.retain(|&j| right(j) >= left(i));
        if let Some(&j) = active.iter().find(|&&j| edges.touch(i, j, lenient)) {
            return Some([i.min(j), i.max(j)]);
        }
        active.push(i);
    }
    None
}

/// Whether the path a, b, c returns onto itself or stands still.
fn folds_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    a == b || b == c || (orient2d(a, b, c) == 0.0 && (within(b, a, c) || within(b, c, a)))
}

/// For collinear points: whether `p` lies between `a` and `b`, ends included,
/// seen from `a`.
fn within(a: DVec2, p: DVec2, b: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all()
}
