//! How often closed polygons cross themselves and each other.

use crate::geometry::{DVec2, orient2d};

/// Proper crossings among the edges of all rings: pairs of edges whose
/// insides meet in one point. Touching does not count. O(n log n) for
/// outlines that are not pathological.
///
/// ```
/// use morphospace::{geometry::DVec2, measure::count_crossings};
/// let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from).to_vec();
/// assert_eq!(count_crossings(&[bow]), 1);
/// ```
#[must_use]
pub fn count_crossings(rings: &[Vec<DVec2>]) -> usize {
    let mut edges: Vec<[DVec2; 2]> = rings
        .iter()
        .flat_map(|ring| {
            let next = ring.iter().skip(1).chain(ring.first());
            ring.iter().zip(next).map(|(&a, &b)| [a, b])
        })
        .collect();
    // Swept along x: an edge meets only those that begin before it ends.
    let left = |edge: &[DVec2; 2]| edge[0].x.min(edge[1].x);
    edges.sort_by(|a, b| left(a).total_cmp(&left(b)));
    let mut count = 0;
    for (i, edge) in edges.iter().enumerate() {
        let right = edge[0].x.max(edge[1].x);
        let near = edges[i + 1..]
            .iter()
            .take_while(|other| left(other) <= right);
        count += near.filter(|other| cross(edge, other)).count();
    }
    count
}

fn cross([a, b]: &[DVec2; 2], [c, d]: &[DVec2; 2]) -> bool {
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return false;
    }
    let apart = |p, q, r, s| orient2d(p, q, r) * orient2d(p, q, s) < 0.0;
    apart(*a, *b, *c, *d) && apart(*c, *d, *a, *b)
}
