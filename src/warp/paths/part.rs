//! A part: an outer ring and the holes that hang on it.
//!
//! A hole keeps to the place of the outer ring that is nearest to it in both
//! designs: a bridge runs from there to the hole's centroid, and its length
//! and its direction are interpolated like those of an edge of the ring. So a
//! hole in a limb goes where the limb goes.

use super::options::RingPair;
use super::ring::IntrinsicRing;
use super::turning::whole_turns;
use crate::geometry::{Bounds, DVec2};

/// A part in source and target, as edges.
#[derive(Clone, Debug)]
pub(super) struct IntrinsicPart {
    outer: IntrinsicRing,
    holes: Vec<BridgedHole>,
}

/// A hole, and the bridge from a vertex of the outer ring to its centroid.
#[derive(Clone, Debug)]
struct BridgedHole {
    ring: IntrinsicRing,
    vertex: usize,
    /// In source and target.
    lengths: [f64; 2],
    /// Direction in the source, in radians.
    angle: f64,
    /// By how much it turns, in radians.
    turn: f64,
}

impl IntrinsicPart {
    /// The outer ring first. The part turns the way that is nearest to
    /// `whole_angle`, in radians.
    pub(super) fn new(rings: &[RingPair], whole_angle: f64) -> Option<Self> {
        let (first, rest) = rings.split_first()?;
        let mut outer = IntrinsicRing::new(&first.source, &first.target, whole_angle);
        outer.turn_near(whole_angle);
        let hole = |pair: &RingPair| BridgedHole::new(&outer, first, pair);
        Some(Self {
            holes: rest.iter().map(hole).collect(),
            outer,
        })
    }

    /// How many vertices all rings have.
    pub(super) fn len(&self) -> usize {
        let holes = self.holes.iter().map(|hole| hole.ring.len());
        self.outer.len() + holes.sum::<usize>()
    }

    /// Writes the vertices of all rings at t, the outer ring's centroid in
    /// the origin.
    pub(super) fn write(&self, t: f64, out: &mut [DVec2]) {
        let (outer, mut rest) = out.split_at_mut(self.outer.len());
        self.outer.write(t, outer);
        for hole in &self.holes {
            let length = hole.lengths[0] * (1.0 - t) + hole.lengths[1] * t;
            let along = DVec2::from_angle(hole.angle + t * hole.turn);
            let centre = outer[hole.vertex] + length * along;
            let (ring, after) = rest.split_at_mut(hole.ring.len());
            hole.ring.write(t, ring);
            ring.iter_mut().for_each(|p| *p += centre);
            rest = after;
        }
    }
}

impl BridgedHole {
    fn new(outer: &IntrinsicRing, around: &RingPair, pair: &RingPair) -> Self {
        let mut ring = IntrinsicRing::new(&pair.source, &pair.target, 0.0);
        let [a, b] = centres(pair, &ring);
        let vertex = nearest(around, [a, b]);
        let spans = [a - around.source[vertex], b - around.target[vertex]];
        let near = outer.turn_at(vertex);
        let [angle, end] = spans.map(DVec2::to_angle);
        // A hole whose centroid is on the boundary in one design has a bridge
        // without a direction there: it turns as the boundary does.
        let has_direction = spans.iter().all(|span| span.length_squared() > 0.0);
        let turn = if has_direction {
            end - angle + whole_turns(end - angle, near)
        } else {
            near
        };
        // A point has no directions of its own to turn from.
        let is_point = |ring: &[DVec2]| ring.iter().all(|p| *p == ring[0]);
        if is_point(&pair.source) || is_point(&pair.target) {
            ring = IntrinsicRing::new(&pair.source, &pair.target, turn);
        }
        ring.turn_near(turn);
        Self {
            ring,
            vertex,
            lengths: spans.map(DVec2::length),
            // Where the source has no direction, that of the target tells.
            angle: if spans[0] == DVec2::ZERO {
                end - turn
            } else {
                angle
            },
            turn,
        }
    }
}

/// The centroids of a ring by its fixed masses. (An area centroid is 0/0 where
/// a ring collapses on its way.)
pub(super) fn centres(pair: &RingPair, ring: &IntrinsicRing) -> [DVec2; 2] {
    [&pair.source, &pair.target].map(|points| {
        let origin = points[0];
        let offsets = points.iter().zip(ring.masses());
        origin + offsets.map(|(&p, m)| m * (p - origin)).sum::<DVec2>()
    })
}

/// The vertex that is nearest to a place in both designs, in diameters.
fn nearest(ring: &RingPair, places: [DVec2; 2]) -> usize {
    let scale = [&ring.source, &ring.target].map(|points| {
        let diameter = Bounds::of(points.iter().copied()).map_or(0.0, |b| b.diameter());
        if diameter > 0.0 { 1.0 / diameter } else { 0.0 }
    });
    let far = |k: usize| {
        ring.source[k].distance(places[0]) * scale[0]
            + ring.target[k].distance(places[1]) * scale[1]
    };
    (0..ring.source.len())
        .min_by(|&a, &b| far(a).total_cmp(&far(b)))
        .unwrap_or(0)
}
