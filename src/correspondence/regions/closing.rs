//! The point that a hole closes to, or a part is born from.
//!
//! A hole's centre is carried to the other design by mean value coordinates
//! of the matched boundary (Floater 2003; signed, as Hormann and Floater 2006
//! use them for any polygon). Where that leaves the part, or comes near its
//! boundary, the nearest place with room is taken.

use super::region_match::POINT_SIZE;
use crate::geometry::{Bounds, DVec2, Region, Ring, ray_hit_parameter};

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
pub(super) struct RingVertices<'a> {
    pub(super) from: &'a [DVec2],
    pub(super) to: &'a [DVec2],
}

/// The room in a part for holes that close to points of it.
pub(super) struct FreeSpace<'a> {
    part: &'a Region,
    /// Places in it with their distance to its boundary.
    places: Vec<(DVec2, f64)>,
    /// The middles of what other holes close to.
    taken: Vec<DVec2>,
    /// How large that is at most.
    size: f64,
}

impl<'a> FreeSpace<'a> {
    pub(super) fn of(part: &'a Region) -> Self {
        let places = places(part).map(|p| (p, to_boundary(part, p)));
        Self {
            places: places.collect(),
            part,
            taken: Vec::new(),
            size: POINT_SIZE * part.outer.bounds().diameter(),
        }
    }

    /// The tiny ring, similar to `hole`, that it closes to in the part, which
    /// it does not belong to. `outer` are the matched boundaries around both.
    pub(super) fn point_ring(
        &mut self,
        hole: &Ring,
        outer: &RingVertices,
        rotation: f64,
    ) -> Vec<DVec2> {
        let wanted = carried(outer, centre(hole));
        let own = wanted.map(|p| (p, to_boundary(self.part, p)));
        let goal = wanted.unwrap_or_else(|| self.part.outer.bounds().centre());
        let nearest = |places: &mut dyn Iterator<Item = (DVec2, f64)>| {
            let far = |place: &(DVec2, f64)| place.0.distance_squared(goal);
            places.min_by(|a, b| far(a).total_cmp(&far(b)))
        };
        let inside = self.places.iter().copied().chain(own);
        let nearest_inside = nearest(&mut inside.clone().filter(|place| place.1 > 0.0));
        let beside = nearest_inside.and_then(|place| self.beside(place));
        let clear = |(p, to_boundary): (DVec2, f64)| (p, self.clear(p, to_boundary));
        let places: Vec<(DVec2, f64)> = inside.chain(beside).map(clear).collect();
        let room = places.iter().map(|place| place.1).fold(0.0, f64::max);
        // Not the roomiest: the hole should close near where it was.
        let mut roomy = places
            .iter()
            .copied()
            .filter(|place| place.1 >= LEAST_CLEARANCE * room);
        let (at, clearance) = nearest(&mut roomy).unwrap_or((goal, room));
        let size = self.size.min(CLEARANCE_SHARE * clearance);
        self.taken.push(at);
        shrunk(hole.points(), centre(hole), at, size, rotation)
    }

    /// What is left of a distance to the boundary where other holes close.
    fn clear(&self, p: DVec2, to_boundary: f64) -> f64 {
        let to_holes = self.taken.iter().map(|q| q.distance(p) - self.size);
        to_holes.fold(to_boundary, f64::min).max(0.0)
    }

    /// The place beside one where another hole closes, as far from it as from
    /// all else; `None` where none does.
    fn beside(&self, (p, to_boundary): (DVec2, f64)) -> Option<(DVec2, f64)> {
        if self.clear(p, to_boundary) > 0.0 {
            return None;
        }
        let others = self.taken.iter().map(|q| q.distance(p));
        let apart = others.filter(|&far| far > self.size);
        let p = p + DVec2::new(0.5 * apart.fold(to_boundary, f64::min), 0.0);
        Some((p, self::to_boundary(self.part, p)))
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
fn carried(outer: &RingVertices, p: DVec2) -> Option<DVec2> {
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
            .filter_map(|edge| ray_hit_parameter(from, inwards, edge))
            .fold(f64::INFINITY, f64::min);
        let place = from + 0.5 * depth * inwards;
        (depth.is_finite() && depth > 0.0 && place.is_finite()).then_some(place)
    })
}

/// Distance to the boundary; 0 outside.
fn to_boundary(part: &Region, p: DVec2) -> f64 {
    if !part.contains(p) {
        return 0.0;
    }
    let to_rings = part.rings().map(|ring| ring.distance_squared(p));
    to_rings.fold(f64::INFINITY, f64::min).sqrt()
}
