//! Finds the point to which a hole closes, or from which one opens.
//!
//! The hole's centre is mapped to the other design by mean value coordinates of the matched
//! boundary (Floater 2003; signed, as Hormann and Floater 2006 use them for arbitrary polygons). If
//! the result lies outside the other design's part, or close to its boundary, the nearest point
//! with enough clearance is used instead.

use super::region_match::POINT_SIZE;
use crate::geometry::{Bounds, DVec2, Region, Ring, ray_hit_parameter};

/// Minimum clearance (distance from the part's boundary and from other tiny rings) of the point to
/// which a hole closes, as a fraction of the largest clearance available. A larger minimum would
/// pull holes to the middle of the part; a smaller one would push them to its boundary, where
/// triangles are thin (heuristic).
const MIN_CLEARANCE: f64 = 0.25;

/// Maximum diameter of the tiny ring that represents a point, as a fraction of the point's
/// clearance. A larger ring would still fit; the rest of the clearance leaves room for the
/// triangles around the ring (heuristic).
const MAX_RING_SIZE: f64 = 0.2;

/// Maximum number of boundary edges from which points inside the part are searched (resource limit:
/// each search visits every edge).
const MAX_SEARCHED_EDGES: usize = 256;

/// Corresponding vertices of one matched ring in both designs.
pub(super) struct RingVertices<'a> {
    /// Vertices in the design that contains the hole.
    pub(super) from: &'a [DVec2],
    /// Vertices in the other design, in which the hole closes to a point.
    pub(super) to: &'a [DVec2],
}

/// Free space inside a part, in which holes of the other design close to points.
pub(super) struct FreeSpace<'a> {
    part: &'a Region,
    /// Points inside the part, with their distances to its boundary.
    places: Vec<(DVec2, f64)>,
    /// Centres of the tiny rings that were placed so far.
    occupied: Vec<DVec2>,
    /// Maximum diameter of a tiny ring that represents a point, in design units.
    size: f64,
}

impl<'a> FreeSpace<'a> {
    /// Collects points inside the part at which holes may close.
    pub(super) fn of(part: &'a Region) -> Self {
        let places = interior_points(part).map(|p| (p, boundary_distance(part, p)));
        Self {
            places: places.collect(),
            part,
            occupied: Vec::new(),
            size: POINT_SIZE * part.outer.bounds().diameter(),
        }
    }

    /// Returns a tiny ring, similar to `hole`, that represents the point of this part to which the
    /// hole closes. `hole` is in the other design, `outer` is the matched boundary around it, and
    /// `rotation` is the rotation of that match in radians.
    pub(super) fn point_ring(
        &mut self,
        hole: &Ring,
        outer: &RingVertices,
        rotation: f64,
    ) -> Vec<DVec2> {
        let mapped = map_by_mean_values(outer, outline_centre(hole));
        let mapped_point = mapped.map(|p| (p, boundary_distance(self.part, p)));
        let target = mapped.unwrap_or_else(|| self.part.outer.bounds().centre());
        let nearest = |points: &mut dyn Iterator<Item = (DVec2, f64)>| {
            let distance = |place: &(DVec2, f64)| place.0.distance_squared(target);
            points.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let points = self.places.iter().copied().chain(mapped_point);
        let nearest_point = nearest(&mut points.clone().filter(|place| place.1 > 0.0));
        let shifted = nearest_point.and_then(|(p, to_boundary)| self.point_next_to(p, to_boundary));
        let with_clearance = |(p, to_boundary): (DVec2, f64)| (p, self.clearance(p, to_boundary));
        let clearances: Vec<(DVec2, f64)> = points.chain(shifted).map(with_clearance).collect();
        let best_clearance = clearances.iter().map(|place| place.1).fold(0.0, f64::max);
        // Take the nearest point with enough clearance, not the point with the largest clearance:
        // the hole should close near its own place.
        let mut candidates = clearances
            .iter()
            .copied()
            .filter(|place| place.1 >= MIN_CLEARANCE * best_clearance);
        let (at, clearance) = nearest(&mut candidates).unwrap_or((target, best_clearance));
        let size = self.size.min(MAX_RING_SIZE * clearance);
        self.occupied.push(at);
        shrink_to(hole.points(), outline_centre(hole), at, size, rotation)
    }

    /// Returns the clearance of a point: its distance `to_boundary` or its distance to the nearest
    /// tiny ring placed so far, whichever is smaller.
    fn clearance(&self, p: DVec2, to_boundary: f64) -> f64 {
        let to_holes = self.occupied.iter().map(|q| q.distance(p) - self.size);
        to_holes.fold(to_boundary, f64::min).max(0.0)
    }

    /// If another hole already closes at the point `p`, returns a point next to `p`, halfway to the
    /// nearest obstacle, and its distance to the boundary. Otherwise returns `None`.
    fn point_next_to(&self, p: DVec2, to_boundary: f64) -> Option<(DVec2, f64)> {
        if self.clearance(p, to_boundary) > 0.0 {
            return None;
        }
        let distances = self.occupied.iter().map(|q| q.distance(p));
        let to_others = distances.filter(|&distance| distance > self.size);
        let p = p + DVec2::new(0.5 * to_others.fold(to_boundary, f64::min), 0.0);
        Some((p, boundary_distance(self.part, p)))
    }
}

/// Returns the points scaled about `centre` to a diameter of `size`, rotated by `rotation` radians
/// and moved to `at`.
pub(super) fn shrink_to(
    points: &[DVec2],
    centre: DVec2,
    at: DVec2,
    size: f64,
    rotation: f64,
) -> Vec<DVec2> {
    let extent = Bounds::of(points.iter().copied()).map_or(1.0, |b| b.diameter());
    let rotation_and_scale = DVec2::from_angle(rotation) * (size / extent);
    let transformed = |&p: &DVec2| at + rotation_and_scale.rotate(p - centre);
    points.iter().map(transformed).collect()
}

/// Returns the mean of a ring's vertices.
pub(super) fn outline_centre(ring: &Ring) -> DVec2 {
    let count = ring.points().len() as f64;
    let base = ring.points()[0];
    let sum: DVec2 = ring.points().iter().map(|&p| p - base).sum();
    base + sum / count
}

/// Maps `p` from one design to the other by its mean value coordinates with respect to the boundary
/// `outer`. Returns `None` if `p` lies on the boundary.
fn map_by_mean_values(outer: &RingVertices, p: DVec2) -> Option<DVec2> {
    let n = outer.from.len();
    // tan(α/2) = sin α / (1 + cos α), where α is the angle from a to b. Numerator and denominator
    // are both multiplied by |a| |b|.
    let half_tangent = |k: usize| {
        let (a, b) = (outer.from[k] - p, outer.from[(k + 1) % n] - p);
        let (cross, dot) = (a.perp_dot(b), a.dot(b));
        cross / (a.length() * b.length() + dot)
    };
    let tangents: Vec<f64> = (0..n).map(half_tangent).collect();
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for k in 0..n {
        let weight = (tangents[(k + n - 1) % n] + tangents[k]) / outer.from[k].distance(p);
        sum += weight * (outer.to[k] - outer.to[0]);
        total += weight;
    }
    // If `p` lies on the boundary, the result is 0 / 0.
    let place = outer.to[0] + sum / total;
    place.is_finite().then_some(place)
}

/// Returns points inside a part. Each lies on the inward normal at the middle of an edge, halfway
/// to the opposite boundary. If the part has many edges, only every few edges are used.
fn interior_points(part: &Region) -> impl Iterator<Item = DVec2> + '_ {
    let count: usize = part.rings().map(|ring| ring.points().len()).sum();
    let step = count.div_ceil(MAX_SEARCHED_EDGES);
    let edges = part.rings().flat_map(Ring::edges).step_by(step);
    edges.filter_map(move |(a, b)| {
        let inwards = (b - a).perp().normalize_or_zero();
        let from = a.midpoint(b);
        let depth = part
            .rings()
            .flat_map(Ring::edges)
            .filter(|edge| *edge != (a, b))
            .filter_map(|(p, q)| ray_hit_parameter(from, inwards, [p, q]))
            .fold(f64::INFINITY, f64::min);
        let place = from + 0.5 * depth * inwards;
        (depth.is_finite() && depth > 0.0 && place.is_finite()).then_some(place)
    })
}

/// Returns the distance of a point to the part's boundary; 0 outside the part.
fn boundary_distance(part: &Region, p: DVec2) -> f64 {
    if !part.contains(p) {
        return 0.0;
    }
    let squared_distances = part.rings().map(|ring| ring.distance_squared(p));
    squared_distances.fold(f64::INFINITY, f64::min).sqrt()
}
