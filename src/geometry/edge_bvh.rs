//! Bounding-volume hierarchy over the edges of closed polygons, for ray and proximity queries.
//!
//! The edges are halved repeatedly at the median of their midpoints, along the longer side of their
//! bounding box. A query for the edges near a short segment takes time roughly proportional to the
//! logarithm of the number of edges, even if the polygons are nested.
//!
//! Guaranteed: the first hit of a ray is the same, to the last bit, as in a search over all edges.
//! The exception is a ray that runs along an edge: rounding decides whether it hits that edge.

use super::ring::ray_crossing;
use super::{Bounds, DVec2, ray_hit_parameter, ring_edges};

/// Maximum number of edges in a leaf of the hierarchy (heuristic).
const LEAF_EDGES: usize = 8;

/// Padding of the boxes, as a fraction of the diameter of all edges (tolerance: far above the
/// rounding of a ray's hit; larger boxes would only cost time).
const PADDING: f64 = 1e-9;

/// Edges of closed polygons with a hierarchy of boxes.
#[derive(Debug)]
pub(crate) struct EdgeBvh {
    edges: Vec<(DVec2, DVec2)>,
    /// Binary tree of nodes in depth-first order. A node with more than [`LEAF_EDGES`] edges has
    /// two children, one for each half of its edges. Each entry holds the box of a node and the
    /// index of its second child; the first child is the next entry. A leaf's index is unused.
    boxes: Vec<(Bounds, usize)>,
}

impl EdgeBvh {
    /// Builds the hierarchy of a closed polygon.
    pub(crate) fn of(points: &[DVec2]) -> Self {
        Self::of_edges(ring_edges(points).collect())
    }

    /// Builds the hierarchy of a list of edges.
    pub(crate) fn of_edges(edges: Vec<(DVec2, DVec2)>) -> Self {
        let count = edges.len();
        let bounds = Bounds::of(edges.iter().flat_map(|&(a, b)| [a, b]));
        let padding = PADDING * bounds.map_or(0.0, |bounds| bounds.diameter());
        let mut hierarchy = Self {
            edges,
            boxes: Vec::new(),
        };
        hierarchy.enclose(0, count, padding);
        hierarchy
    }

    /// Returns the edges, in no particular order.
    pub(crate) fn edges(&self) -> &[(DVec2, DVec2)] {
        &self.edges
    }

    /// Appends the box of the edges `from..to`. If there are too many edges for a leaf, then
    /// divides them into two halves and appends the subtrees of these.
    fn enclose(&mut self, from: usize, to: usize, padding: f64) {
        let edges = &mut self.edges[from..to];
        let Some(bounds) = Bounds::of(edges.iter().flat_map(|&(a, b)| [a, b])) else {
            return;
        };
        let own = self.boxes.len();
        self.boxes.push((bounds.padded(padding), own));
        if to - from > LEAF_EDGES {
            let half = (to - from) / 2;
            let size = bounds.size();
            let along = |&(a, b): &(DVec2, DVec2)| match size.x >= size.y {
                true => a.x + b.x,
                false => a.y + b.y,
            };
            edges.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)));
            let middle = from + half;
            self.enclose(from, middle, padding);
            // The index of the second half is known only now that the first half is complete.
            self.boxes[own].1 = self.boxes.len();
            self.enclose(middle, to, padding);
        }
    }

    /// Returns the distance from `from` at which a ray first hits an edge, ignoring hits up to
    /// `min_distance`; infinity if there is none. All distances, `min_distance` included, are
    /// multiples of the length of `direction`.
    pub(crate) fn first_hit_beyond(&self, from: DVec2, direction: DVec2, min_distance: f64) -> f64 {
        let ray = Ray {
            from,
            direction,
            inverse: direction.recip(),
            min_distance,
        };
        let mut nearest = f64::INFINITY;
        if !self.boxes.is_empty() {
            self.visit(&ray, 0, 0, self.edges.len(), &mut nearest);
        }
        nearest
    }

    /// Returns whether `is` holds for an edge near the box `place`, that is, for an edge whose
    /// bounding box meets `place`.
    pub(crate) fn any_edge_near(&self, place: &Bounds, is: &dyn Fn([DVec2; 2]) -> bool) -> bool {
        !self.boxes.is_empty() && self.any_within(place, is, 0, 0, self.edges.len())
    }

    /// As [`Self::any_edge_near`], but only in the subtree of `node`, which holds the edges
    /// `from..to`.
    fn any_within(
        &self,
        place: &Bounds,
        is: &dyn Fn([DVec2; 2]) -> bool,
        node: usize,
        from: usize,
        to: usize,
    ) -> bool {
        let (bounds, second) = &self.boxes[node];
        if !bounds.meets(place) {
            return false;
        }
        if to - from <= LEAF_EDGES {
            let is_near = |a: DVec2, b: DVec2| {
                let bounds = Bounds {
                    min: a.min(b),
                    max: a.max(b),
                };
                bounds.meets(place)
            };
            let mut edges = self.edges[from..to].iter();
            return edges.any(|&(a, b)| is_near(a, b) && is([a, b]));
        }
        let middle = from + (to - from) / 2;
        self.any_within(place, is, node + 1, from, middle)
            || self.any_within(place, is, *second, middle, to)
    }

    /// Returns the sum of the winding numbers of the polygons around `p`; see
    /// [`winding`](super::winding).
    pub(crate) fn winding(&self, p: DVec2) -> i32 {
        match self.boxes.is_empty() {
            true => 0,
            false => self.winding_within(p, 0, 0, self.edges.len()),
        }
    }

    /// As [`Self::winding`], for the edges `from..to` in the subtree of `node`.
    fn winding_within(&self, p: DVec2, node: usize, from: usize, to: usize) -> i32 {
        let (bounds, second) = &self.boxes[node];
        // Only edges at the height of `p` and to the right of it count.
        if p.y < bounds.min.y || p.y > bounds.max.y || p.x > bounds.max.x {
            return 0;
        }
        if to - from <= LEAF_EDGES {
            let edges = self.edges[from..to].iter();
            return edges.map(|&edge| ray_crossing(edge, p)).sum();
        }
        let middle = from + (to - from) / 2;
        self.winding_within(p, node + 1, from, middle) + self.winding_within(p, *second, middle, to)
    }

    /// Lowers `nearest` to the distance of the first hit in the subtree of `node`, which holds the
    /// edges `from..to`, if that hit is nearer.
    fn visit(&self, ray: &Ray, node: usize, from: usize, to: usize, nearest: &mut f64) {
        let (bounds, second) = &self.boxes[node];
        if !ray.enters(bounds, *nearest) {
            return;
        }
        if to - from <= LEAF_EDGES {
            for &(a, b) in &self.edges[from..to] {
                let distance = ray_hit_parameter(ray.from, ray.direction, [a, b]);
                *nearest = distance
                    .filter(|distance| *distance > ray.min_distance)
                    .map_or(*nearest, |distance| nearest.min(distance));
            }
            return;
        }
        let middle = from + (to - from) / 2;
        self.visit(ray, node + 1, from, middle, nearest);
        self.visit(ray, *second, middle, to, nearest);
    }
}

/// Ray with the reciprocals that the box test needs.
struct Ray {
    from: DVec2,
    direction: DVec2,
    /// Reciprocals of the components of `direction`.
    inverse: DVec2,
    /// Distance up to which hits are ignored, as a multiple of the length of `direction`.
    min_distance: f64,
}

impl Ray {
    /// Returns whether the ray enters a box at a distance of at most `nearest`.
    fn enters(&self, bounds: &Bounds, nearest: f64) -> bool {
        let [low, high] =
            [bounds.min, bounds.max].map(|corner| (corner - self.from) * self.inverse);
        // Slab test: the ray is in the box while it is in both coordinate ranges.
        let (mut enter, mut leave) = (0.0_f64, nearest);
        for (low, high) in [(low.x, high.x), (low.y, high.y)] {
            // 0 · ∞ is NaN: the ray runs along the line of a side of the box, so this coordinate
            // does not rule out that the ray enters the box.
            if !low.is_nan() && !high.is_nan() {
                enter = enter.max(low.min(high));
                leave = leave.min(low.max(high));
            }
        }
        enter <= leave
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{segments_cross, winding};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_ray_hits_the_same_edge_as_in_a_search_over_all(
            points in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 1..80),
            from in (-1.5f64..1.5, -1.5f64..1.5),
            turn in 0.0f64..6.3,
            own in 0.0f64..0.2,
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let (from, direction) = (DVec2::from(from), DVec2::from_angle(turn));
            let met = ring_edges(&points)
                .filter_map(|(a, b)| ray_hit_parameter(from, direction, [a, b]));
            let slow = met.filter(|far| *far > own).fold(f64::INFINITY, f64::min);
            let fast = EdgeBvh::of(&points).first_hit_beyond(from, direction, own);
            prop_assert_eq!(slow, fast);
        }

        #[test]
        fn a_proximity_query_agrees_with_a_test_of_all_edges(
            points in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 1..80),
            from in (-1.5f64..1.5, -1.5f64..1.5),
            by in (-0.3f64..0.3, -0.3f64..0.3),
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let a = DVec2::from(from);
            let segment = [a, a + DVec2::from(by)];
            let crosses = |edge: [DVec2; 2]| segments_cross(segment, edge);
            let slow = ring_edges(&points).any(|(a, b)| crosses([a, b]));
            let place = Bounds::of(segment).expect("two points");
            prop_assert_eq!(slow, EdgeBvh::of(&points).any_edge_near(&place, &crosses));
        }

        #[test]
        fn the_winding_number_is_that_of_all_edges(
            points in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 1..80),
            p in (-1.5f64..1.5, -1.5f64..1.5),
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let p = DVec2::from(p);
            prop_assert_eq!(EdgeBvh::of(&points).winding(p), winding(&points, p));
            let corner = points[0];
            prop_assert_eq!(EdgeBvh::of(&points).winding(corner), winding(&points, corner));
        }

        #[test]
        fn rays_along_the_axes_meet_a_staircase(x in 0u32..40, y in 0u32..40, turn in 0u32..4) {
            let steps = (0..20).flat_map(|k| [(k, k), (k + 1, k)]);
            let stairs: Vec<DVec2> = steps.chain([(20, 40), (0, 40)])
                .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)))
                .collect();
            let direction = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y][turn as usize];
            let from = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let met = ring_edges(&stairs)
                .filter_map(|(a, b)| ray_hit_parameter(from, direction, [a, b]));
            let slow = met.fold(f64::INFINITY, f64::min);
            prop_assert_eq!(slow, EdgeBvh::of(&stairs).first_hit_beyond(from, direction, 0.0));
        }
    }
}
