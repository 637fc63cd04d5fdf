//! Separates outlines that touch in single points.
//!
//! A region may touch itself in a point, and so may two of its holes. Such a region looks right,
//! but a triangulation fails: rounding decides on which side of the contact a point lies, so the
//! region may seem disconnected. Where two corners meet in a point, the sharper one is therefore
//! moved back, between its own edges, by an invisible distance.

use super::{Bounds, DVec2, Region, Regions, Ring, distance_squared_to_segment};

/// Maximum distance at which a corner counts as touching an edge, as a fraction of the regions'
/// diameter (tolerance: far above the rounding of points that are placed on edges).
const CONTACT_DISTANCE: f64 = 1e-9;

/// Distance by which a touching corner is moved back, as a fraction of the regions' diameter
/// (tolerance: a hundredth of a pixel in an image 10,000 pixels wide).
const SETBACK: f64 = 1e-6;
/// Maximum distance by which a touching corner is moved back, as a fraction of its shorter edge
/// (heuristic).
const MAX_SETBACK_SHARE: f64 = 0.1;

impl Regions {
    /// Returns the regions with the point contacts inside each region separated. All other points
    /// stay exactly where they are.
    pub(crate) fn with_contacts_separated(&self) -> Self {
        let diameter = self.bounds().diameter();
        let apart = |region: &Region| {
            let region_corners = RegionCorners::of(region);
            let points = region_corners.drawn_back(diameter);
            let mut remaining = &points[..];
            let mut ring = |ring: &Ring| {
                let (own, others) = remaining.split_at(ring.points().len());
                remaining = others;
                // A ring that would collapse stays as it is.
                Ring::new(own.to_vec()).unwrap_or_else(|_| ring.clone())
            };
            Region {
                outer: ring(&region.outer),
                holes: region.holes.iter().map(ring).collect(),
            }
        };
        self.map_regions(apart)
    }
}

impl Region {
    /// Returns whether rings of the region touch each other or themselves, or did so before their
    /// contacts were separated. `diameter` is that of all regions of the design.
    pub(crate) fn has_contacts(&self, diameter: f64) -> bool {
        // A corner that was moved back lies one setback away from where it was.
        !RegionCorners::of(self)
            .touching(2.0 * SETBACK * diameter)
            .is_empty()
    }
}

/// Corners of a region, numbered consecutively, ring by ring.
struct RegionCorners {
    points: Vec<DVec2>,
    /// For each corner: indices of the previous and the next corner of its ring.
    neighbours: Vec<[usize; 2]>,
}

impl RegionCorners {
    /// Collects the corners of all rings of a region.
    fn of(region: &Region) -> Self {
        let (mut points, mut neighbours) = (Vec::new(), Vec::new());
        for ring in region.rings() {
            let (first, n) = (points.len(), ring.points().len());
            points.extend_from_slice(ring.points());
            neighbours.extend((0..n).map(|k| [(k + n - 1) % n, (k + 1) % n].map(|k| first + k)));
        }
        Self { points, neighbours }
    }

    /// Returns all corners, with the touching ones moved back.
    fn drawn_back(&self, diameter: f64) -> Vec<DVec2> {
        let mut points = self.points.clone();
        for corner in self.touching(CONTACT_DISTANCE * diameter) {
            let here = self.points[corner];
            let edges = self.neighbours[corner].map(|k| self.points[k] - here);
            // Move the corner along the bisector, so that it stays between its edges.
            let [a, b] = edges.map(DVec2::normalize_or_zero);
            let max_setback = MAX_SETBACK_SHARE * edges[0].length().min(edges[1].length());
            points[corner] =
                here + (a + b).normalize_or_zero() * max_setback.min(SETBACK * diameter);
        }
        points
    }

    /// Returns the indices of the corners that lie within `near` of an edge that does not end in
    /// them. If several corners meet in one point, the bluntest of them is left out.
    fn touching(&self, near: f64) -> Vec<usize> {
        let mut by_x: Vec<usize> = (0..self.points.len()).collect();
        by_x.sort_by(|&a, &b| self.points[a].x.total_cmp(&self.points[b].x));
        let mut touching = Vec::new();
        for edge in 0..self.points.len() {
            let ends = [edge, self.neighbours[edge][1]];
            let [a, b] = ends.map(|k| self.points[k]);
            let bounds = Bounds {
                min: a.min(b) - near,
                max: a.max(b) + near,
            };
            // In the order of x, the corners in the x range of an edge are consecutive.
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
                // Of two corners at the same point, only the sharper one is moved.
                let is_sharper = |end: usize| {
                    let meets = p.distance_squared(self.points[end]) <= near * near;
                    meets && (self.width(end), end) < (self.width(corner), corner)
                };
                if is_near && !ends.into_iter().any(is_sharper) {
                    touching.push(corner);
                }
            }
        }
        touching.sort_unstable();
        touching.dedup();
        touching
    }

    /// Returns how blunt a corner is: 1 − cos of the angle between its edges, 0 for a spike and 2
    /// for a straight line.
    fn width(&self, corner: usize) -> f64 {
        let here = self.points[corner];
        let [a, b] = self.neighbours[corner].map(|k| (self.points[k] - here).normalize_or_zero());
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
        let near = CONTACT_DISTANCE * regions.bounds().diameter();
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
        let after = before.with_contacts_separated();
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
        assert_eq!(touching(&before.with_contacts_separated()), 0);
    }

    #[test]
    fn regions_without_contact_stay_as_they_are() {
        let square = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        let hole = [(4.0, 1.0), (6.0, 4.0), (2.0, 4.0)];
        let before = regions(&[&square, &hole]);
        assert_eq!(before.with_contacts_separated(), before);
    }
}
