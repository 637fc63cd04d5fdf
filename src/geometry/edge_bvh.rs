//! The edges of a closed polygon in boxes within boxes, so that a ray, or
//! whoever asks for the edges near a place, looks at few of them.
//!
//! Runs of edges that follow each other lie near each other: they are halved
//! as they are listed, without sorting. A ray costs about the logarithm of the
//! number of edges, instead of all of them.
//!
//! Guaranteed: the same edge is met first, to the last bit, as when all are
//! looked at, but for rays along an edge, which meet it by rounding alone.

use super::{Bounds, DVec2, ray_hit_parameter, ring_edges};

/// Edges that are looked at one by one.
const RUN: usize = 8;

/// Boxes are larger by this share of the whole: far more than the rounding of
/// where a ray meets an edge, far less than any edge's box.
const SLACK: f64 = 1e-9;

/// A closed polygon's edges.
#[derive(Debug)]
pub(crate) struct EdgeBvh {
    edges: Vec<(DVec2, DVec2)>,
    /// A tree in depth-first order: the box of the first half follows at once,
    /// that of the second where the number says.
    boxes: Vec<(Bounds, usize)>,
}

impl EdgeBvh {
    /// The edges of a closed polygon.
    pub(crate) fn of(points: &[DVec2]) -> Self {
        let mut boxes = Self {
            edges: ring_edges(points).collect(),
            boxes: Vec::new(),
        };
        let slack = SLACK * Bounds::diameter_of(points);
        boxes.enclose(0, points.len(), slack);
        boxes
    }

    /// Pushes the box of a range of edges, and those within it.
    fn enclose(&mut self, from: usize, to: usize, slack: f64) {
        let ends = self.edges[from..to].iter().flat_map(|&(a, b)| [a, b]);
        let Some(bounds) = Bounds::of(ends) else {
            return;
        };
        let own = self.boxes.len();
        self.boxes.push((bounds.padded(slack), own));
        if to - from > RUN {
            let middle = from + (to - from) / 2;
            self.enclose(from, middle, slack);
            self.boxes[own].1 = self.boxes.len();
            self.enclose(middle, to, slack);
        }
    }

    /// How far a ray goes to the first edge beyond `own`, in lengths of
    /// `direction`; infinite if to none.
    pub(crate) fn first_beyond(&self, from: DVec2, direction: DVec2, own: f64) -> f64 {
        let ray = Ray {
            from,
            direction,
            inverse: direction.recip(),
            own,
        };
        let mut nearest = f64::INFINITY;
        if !self.boxes.is_empty() {
            self.visit(&ray, 0, 0, self.edges.len(), &mut nearest);
        }
        nearest
    }

    /// Whether `is` holds for an edge near `place`: all whose box meets it are
    /// asked, and some more, until one says so.
    pub(crate) fn any_near(&self, place: &Bounds, is: &dyn Fn([DVec2; 2]) -> bool) -> bool {
        !self.boxes.is_empty() && self.any_within(place, is, 0, 0, self.edges.len())
    }

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
        if to - from <= RUN {
            return self.edges[from..to].iter().any(|&(a, b)| is([a, b]));
        }
        let middle = from + (to - from) / 2;
        self.any_within(place, is, node + 1, from, middle)
            || self.any_within(place, is, *second, middle, to)
    }

    fn visit(&self, ray: &Ray, node: usize, from: usize, to: usize, nearest: &mut f64) {
        let (bounds, second) = &self.boxes[node];
        if !ray.enters(bounds, *nearest) {
            return;
        }
        if to - from <= RUN {
            for &edge in &self.edges[from..to] {
                let far = ray_hit_parameter(ray.from, ray.direction, edge);
                *nearest = far
                    .filter(|far| *far > ray.own)
                    .map_or(*nearest, |far| nearest.min(far));
            }
            return;
        }
        let middle = from + (to - from) / 2;
        self.visit(ray, node + 1, from, middle, nearest);
        self.visit(ray, *second, middle, to, nearest);
    }
}

struct Ray {
    from: DVec2,
    direction: DVec2,
    inverse: DVec2,
    own: f64,
}

impl Ray {
    /// Whether the ray is in a box before it is as far as `nearest`.
    fn enters(&self, bounds: &Bounds, nearest: f64) -> bool {
        let [low, high] =
            [bounds.min, bounds.max].map(|corner| (corner - self.from) * self.inverse);
        let (mut enter, mut leave) = (0.0_f64, nearest);
        for (low, high) in [(low.x, high.x), (low.y, high.y)] {
            // 0 · ∞: a ray along a side of the box, which keeps it in.
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
    use crate::geometry::segments_cross;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_ray_meets_what_it_meets_among_all_edges(
            points in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 1..80),
            from in (-1.5f64..1.5, -1.5f64..1.5),
            turn in 0.0f64..6.3,
            own in 0.0f64..0.2,
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let (from, direction) = (DVec2::from(from), DVec2::from_angle(turn));
            let met = ring_edges(&points).filter_map(|edge| ray_hit_parameter(from, direction, edge));
            let slow = met.filter(|far| *far > own).fold(f64::INFINITY, f64::min);
            let fast = EdgeBvh::of(&points).first_beyond(from, direction, own);
            prop_assert_eq!(slow, fast);
        }

        #[test]
        fn what_crosses_an_edge_near_it_crosses_one_of_all(
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
            prop_assert_eq!(slow, EdgeBvh::of(&points).any_near(&place, &crosses));
        }

        #[test]
        fn rays_along_the_axes_meet_a_staircase(x in 0u32..40, y in 0u32..40, turn in 0u32..4) {
            let steps = (0..20).flat_map(|k| [(k, k), (k + 1, k)]);
            let stairs: Vec<DVec2> = steps.chain([(20, 40), (0, 40)])
                .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)))
                .collect();
            let direction = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y][turn as usize];
            let from = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let met = ring_edges(&stairs).filter_map(|edge| ray_hit_parameter(from, direction, edge));
            let slow = met.fold(f64::INFINITY, f64::min);
            prop_assert_eq!(slow, EdgeBvh::of(&stairs).first_beyond(from, direction, 0.0));
        }
    }
}
