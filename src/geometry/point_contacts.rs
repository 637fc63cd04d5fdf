//! Outlines that touch in single points, pulled apart.
//!
//! A region may touch itself in a point, or two of its holes each other: it
//! is seen well, yet it is no one piece to a triangulation, and what holds there
//! for one side holds for the other by luck. Of what meets in a point the
//! sharper corner is drawn back into itself, by less than is ever seen.

use super::{Bounds, DVec2, Region, Regions, Ring, distance_squared_to_segment};

/// What is nearer than this counts as touching, in diameters of the regions.
/// Far above the digits lost where points are put on edges.
const TOUCH: f64 = 1e-9;

/// How far a corner is drawn back, in diameters, and as a share of its shorter
/// edge at most. A hundredth of a pixel over the width of ten thousand.
const BACK: f64 = 1e-6;
const SHARE: f64 = 0.1;

impl Regions {
    /// The same regions, apart where they touched in points; their own points
    /// elsewhere, bit by bit.
    pub(crate) fn pulled_apart(&self) -> Self {
        let diameter = self.bounds().diameter();
        let apart = |region: &Region| {
            let corners = RegionCorners::of(region);
            let points = corners.drawn_back(diameter);
            let mut rest = &points[..];
            let mut ring = |ring: &Ring| {
                let (own, others) = rest.split_at(ring.points().len());
                rest = others;
                Ring::new(own.to_vec()).unwrap_or_else(|_| ring.clone())
            };
            Region {
                outer: ring(&region.outer),
                holes: region.holes.iter().map(ring).collect(),
            }
        };
        self.mapped(apart)
    }
}

/// The corners of a region, numbered through ring by ring.
struct RegionCorners {
    points: Vec<DVec2>,
    /// The corner before each and the one after.
    beside: Vec<[usize; 2]>,
}

impl RegionCorners {
    fn of(region: &Region) -> Self {
        let (mut points, mut beside) = (Vec::new(), Vec::new());
        for ring in region.rings() {
            let (first, n) = (points.len(), ring.points().len());
            points.extend_from_slice(ring.points());
            beside.extend((0..n).map(|k| [(k + n - 1) % n, (k + 1) % n].map(|k| first + k)));
        }
        Self { points, beside }
    }

    fn drawn_back(&self, diameter: f64) -> Vec<DVec2> {
        let mut points = self.points.clone();
        for corner in self.touching(TOUCH * diameter) {
            let here = self.points[corner];
            let edges = self.beside[corner].map(|k| self.points[k] - here);
            let [a, b] = edges.map(DVec2::normalize_or_zero);
            let most = SHARE * edges[0].length().min(edges[1].length());
            points[corner] = here + (a + b).normalize_or_zero() * most.min(BACK * diameter);
        }
        points
    }

    /// The corners that lie on other edges, but for the bluntest of those that
    /// meet in one point.
    fn touching(&self, near: f64) -> Vec<usize> {
        let mut by_x: Vec<usize> = (0..self.points.len()).collect();
        by_x.sort_by(|&a, &b| self.points[a].x.total_cmp(&self.points[b].x));
        let mut found = Vec::new();
        for edge in 0..self.points.len() {
            let ends = [edge, self.beside[edge][1]];
            let [a, b] = ends.map(|k| self.points[k]);
            let bounds = Bounds {
                min: a.min(b) - near,
                max: a.max(b) + near,
            };
            let from = by_x.partition_point(|&k| self.points[k].x < bounds.min.x);
            let within = by_x[from..]
                .iter()
                .copied()
                .take_while(|&k| self.points[k].x <= bounds.max.x);
            for corner in within {
                let p = self.points[corner];
                let is_near = !ends.contains(&corner)
                    && bounds.contains(p)
                    && distance_squared_to_segment(p, a, b) <= near * near;
                let is_blunter = |end: usize| {
                    let meets = p.distance_squared(self.points[end]) <= near * near;
                    meets && (self.width(end), end) < (self.width(corner), corner)
                };
                if is_near && !ends.into_iter().any(is_blunter) {
                    found.push(corner);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// How wide a corner is, as 1 − cos of the angle between its edges.
    fn width(&self, corner: usize) -> f64 {
        let here = self.points[corner];
        let [a, b] = self.beside[corner].map(|k| (self.points[k] - here).normalize_or_zero());
        1.0 - a.dot(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::FillRule;

    fn regions(rings: &[&[(f64, f64)]]) -> Regions {
        let ring = |ring: &&[(f64, f64)]| ring.iter().copied().map(DVec2::from).collect();
        let rings: Vec<Vec<DVec2>> = rings.iter().map(ring).collect();
        Regions::from_rings(&rings, FillRule::EvenOdd).expect("regions")
    }

    fn touching(regions: &Regions) -> usize {
        let near = TOUCH * regions.bounds().diameter();
        let counts = regions
            .iter()
            .map(|r| RegionCorners::of(r).touching(near).len());
        counts.sum()
    }

    #[test]
    fn holes_that_touch_in_a_corner_come_apart() {
        let square = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        let sharp = [(4.0, 4.0), (1.0, 3.0), (1.0, 5.0)];
        let blunt = [(4.0, 4.0), (7.0, 6.0), (7.0, 2.0)];
        let before = regions(&[&square, &sharp, &blunt]);
        assert_eq!(touching(&before), 1);
        let after = before.pulled_apart();
        assert_eq!(touching(&after), 0);
        let moved = before
            .rings()
            .zip(after.rings())
            .flat_map(|(a, b)| a.points().iter().zip(b.points()).filter(|(p, q)| p != q));
        let moved: Vec<f64> = moved.map(|(p, q)| p.distance(*q)).collect();
        assert!(moved.len() == 1 && moved[0] < 2e-5, "{moved:?}");
        assert!((before.area() - after.area()).abs() < 1e-4);
    }

    #[test]
    fn a_corner_on_a_side_comes_off_it() {
        let square = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        let hole = [(4.0, 0.0), (6.0, 4.0), (2.0, 4.0)];
        let before = regions(&[&square, &hole]);
        assert_eq!(touching(&before.pulled_apart()), 0);
    }

    #[test]
    fn what_touches_nowhere_is_left_as_it_is() {
        let square = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        let hole = [(4.0, 1.0), (6.0, 4.0), (2.0, 4.0)];
        let before = regions(&[&square, &hole]);
        assert_eq!(before.pulled_apart(), before);
    }
}
