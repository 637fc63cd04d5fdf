//! The point that a hole closes to, or a part is born from.
//!
//! A hole's centre is carried to the other design by mean value coordinates
//! of the matched boundary (Floater 2003; signed, as Hormann and Floater 2006
//! use them for any polygon). Where that leaves the part, or comes near its
//! boundary, the nearest place with room is taken.

use super::outcome::POINT_SIZE;
use crate::geometry::{Bounds, DVec2, Region, Ring, along_ray};

/// A place keeps at least this share of the best clearance there is.
/// More would draw holes to the middle of the part, less to its rim, where
/// triangles are thin.
const LEAST_CLEARANCE: f64 = 0.25;

/// A tiny ring takes up at most this share of its place's clearance.
/// Up to ½ would fit; the rest is room for the triangles around it.
const CLEARANCE_SHARE: f64 = 0.2;

/// How many places of the boundary are searched for room.
/// Each costs a look at every edge: a bound for outlines of thousands.
const SEARCHED: usize = 256;

/// Points of one ring on both sides, vertex by vertex.
pub(super) struct Vertices<'a> {
    pub(super) from: &'a [DVec2],
    pub(super) to: &'a [DVec2],
}

/// The room in a part for holes that close to points of it.
pub(super) struct Room<'a> {
    part: &'a Region,
    /// Places in it with their squared distance to its boundary.
    places: Vec<(DVec2, f64)>,
    /// The points that other holes close to.
    taken: Vec<DVec2>,
}

impl<'a> Room<'a> {
    pub(super) fn of(part: &'a Region) -> Self {
        let places = places(part).map(|p| (p, clearance_squared(part, p)));
        Self {
            places: places.collect(),
            part,
            taken: Vec::new(),
        }
    }

    /// The tiny ring, similar to `hole`, that it closes to in the part, which
    /// it does not belong to. `outer` are the matched boundaries around both.
    pub(super) fn point_ring(
        &mut self,
        hole: &Ring,
        outer: &Vertices,
        rotation: f64,
    ) -> Vec<DVec2> {
        let wanted = carried(outer, centre(hole));
        let clear = |&(p, to_rings): &(DVec2, f64)| {
            let to_points = self.taken.iter().map(|q| q.distance_squared(p));
            (p, to_points.fold(to_rings, f64::min).sqrt())
        };
        let mut places: Vec<(DVec2, f64)> = self.places.iter().map(clear).collect();
        if let Some(p) = wanted {
            places.push(clear(&(p, clearance_squared(self.part, p))));
        }
        let room = places.iter().map(|place| place.1).fold(0.0, f64::max);
        let goal = wanted.unwrap_or_else(|| self.part.outer.bounds().centre());
        // Not the roomiest: the hole should close near where it was.
        let roomy = places
            .iter()
            .filter(|place| place.1 >= LEAST_CLEARANCE * room);
        let nearest = roomy.min_by(|a, b| {
            let far = |p: &DVec2| p.distance_squared(goal);
            far(&a.0).total_cmp(&far(&b.0))
        });
        let (at, clearance) = nearest.copied().unwrap_or((goal, room));
        let across = self.part.outer.bounds().diameter();
        let size = (POINT_SIZE * across).min(CLEARANCE_SHARE * clearance);
        let ring = shrunk(hole.points(), centre(hole), at, size, rotation);
        self.taken.extend(ring.first());
        ring
    }
}

/// Points about `centre` made as small as `size` across, turned and put down
/// at `at`.
pub(super) fn shrunk(
    points: &[DVec2],
    centre: DVec2,
    at: DVec2,
    size: f64,
    rotation: f64,
) -> Vec<DVec2> {
    let extent = Bounds::of(points.iter().copied()).map_or(1.0, |b| b.diameter());
    let turn = DVec2::from_angle(rotation) * (size / extent);
    let place = |&p: &DVec2| at + turn.rotate(p - centre);
    points.iter().map(place).collect()
}

pub(super) fn centre(ring: &Ring) -> DVec2 {
    let count = ring.points().len() as f64;
    let base = ring.points()[0];
    let sum: DVec2 = ring.points().iter().map(|&p| p - base).sum();
    base + sum / count
}

/// Where mean value coordinates put `p`.
fn carried(outer: &Vertices, p: DVec2) -> Option<DVec2> {
    let n = outer.from.len();
    // tan(α/2) from sine and cosine of α, times both lengths, which cancel.
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
    // A place on the outline itself gives 0 / 0: then there is none.
    let place = outer.to[0] + sum / total;
    place.is_finite().then_some(place)
}

/// Places inside a part, halfway from boundary to boundary.
fn places(part: &Region) -> impl Iterator<Item = DVec2> + '_ {
    let count: usize = part.rings().map(|ring| ring.points().len()).sum();
    let step = count.div_ceil(SEARCHED);
    let edges = part.rings().flat_map(Ring::edges).step_by(step);
    edges.filter_map(move |(a, b)| {
        let inwards = (b - a).perp().normalize_or_zero();
        let from = a.midpoint(b);
        let depth = part
            .rings()
            .flat_map(Ring::edges)
            .filter(|edge| *edge != (a, b))
            .filter_map(|edge| along_ray(from, inwards, edge))
            .fold(f64::INFINITY, f64::min);
        let place = from + 0.5 * depth * inwards;
        (depth.is_finite() && depth > 0.0 && place.is_finite()).then_some(place)
    })
}

/// Squared distance to the boundary; 0 outside.
fn clearance_squared(part: &Region, p: DVec2) -> f64 {
    if !part.contains(p) {
        return 0.0;
    }
    let to_rings = part.rings().map(|ring| ring.distance_squared(p));
    to_rings.fold(f64::INFINITY, f64::min)
}
