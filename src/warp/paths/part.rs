//! Intrinsic interpolation of a part: an outer ring with its holes.
//!
//! Each hole is attached to the vertex of the outer ring that is nearest to it in both designs. A
//! bridge leads from that vertex to the hole's centroid, and its length and direction are
//! interpolated like those of a ring edge. A hole in a limb therefore moves with the limb.

use super::options::RingPair;
use super::ring::IntrinsicRing;
use super::turning::whole_turns;
use crate::geometry::{Bounds, DVec2};

/// A part as edge lengths and directions in source and target.
#[derive(Clone, Debug)]
pub(super) struct IntrinsicPart {
    outer: IntrinsicRing,
    holes: Vec<BridgedHole>,
}

/// A hole with its bridge from a vertex of the outer ring to the hole's centroid.
#[derive(Clone, Debug)]
struct BridgedHole {
    ring: IntrinsicRing,
    /// Index of the bridge's vertex in the outer ring.
    vertex: usize,
    /// Length of the bridge in source and target.
    lengths: [f64; 2],
    /// Direction of the bridge in the source, in radians.
    angle: f64,
    /// Rotation of the bridge from source to target, in radians.
    turn: f64,
}

impl IntrinsicPart {
    /// Creates a part from its rings, the outer ring first; `None` if there are no rings.
    ///
    /// Of all rotations that differ by whole turns, the part takes the one nearest to
    /// `whole_angle`, in radians.
    pub(super) fn new(rings: &[RingPair], whole_angle: f64) -> Option<Self> {
        let (first, rest) = rings.split_first()?;
        let mut outer = IntrinsicRing::new(&first.source, &first.target, whole_angle);
        outer.choose_whole_turns(whole_angle);
        let hole = |pair: &RingPair| BridgedHole::new(&outer, first, pair);
        Some(Self {
            holes: rest.iter().map(hole).collect(),
            outer,
        })
    }

    /// Returns the number of vertices of all rings of the part.
    pub(super) fn len(&self) -> usize {
        let holes = self.holes.iter().map(|hole| hole.ring.len());
        self.outer.len() + holes.sum::<usize>()
    }

    /// Writes the vertices of all rings at t, with the outer ring's centroid at the origin.
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
    /// Attaches the hole `pair` to the outer ring `around`, whose edges are `outer`.
    fn new(outer: &IntrinsicRing, around: &RingPair, pair: &RingPair) -> Self {
        let mut ring = IntrinsicRing::new(&pair.source, &pair.target, 0.0);
        let [a, b] = centres(pair, &ring);
        let vertex = nearest_vertex(around, [a, b]);
        let bridges = [a - around.source[vertex], b - around.target[vertex]];
        let boundary_turn = outer.turn_at(vertex);
        let [angle, end] = bridges.map(DVec2::to_angle);
        // If the hole's centroid is at the vertex in one design, the bridge has no direction
        // there and rotates like the boundary.
        let has_direction = bridges.iter().all(|bridge| bridge.length_squared() > 0.0);
        let turn = if has_direction {
            end - angle + whole_turns(end - angle, boundary_turn)
        } else {
            boundary_turn
        };
        // A hole that is a point in one design has no edge directions there, so it rotates with its
        // bridge.
        let is_point = |ring: &[DVec2]| ring.iter().all(|p| *p == ring[0]);
        if is_point(&pair.source) || is_point(&pair.target) {
            ring = IntrinsicRing::new(&pair.source, &pair.target, turn);
        }
        ring.choose_whole_turns(turn);
        Self {
            ring,
            vertex,
            lengths: bridges.map(DVec2::length),
            // A bridge without a direction in the source takes its direction in the target, rotated
            // back.
            angle: if bridges[0] == DVec2::ZERO {
                end - turn
            } else {
                angle
            },
            turn,
        }
    }
}

/// Returns the centroids of a ring in source and target.
///
/// The masses of the vertices do not depend on t, because an area centroid would be 0/0 where a
/// ring collapses in between.
pub(super) fn centres(pair: &RingPair, ring: &IntrinsicRing) -> [DVec2; 2] {
    [&pair.source, &pair.target].map(|points| {
        let origin = points[0];
        let offsets = points.iter().zip(ring.masses());
        origin + offsets.map(|(&p, m)| m * (p - origin)).sum::<DVec2>()
    })
}

/// Returns the index of the vertex of `ring` with the smallest sum of distances to `points`, one
/// point in each design.
///
/// Distances are relative to the ring's diameter in each design.
fn nearest_vertex(ring: &RingPair, points: [DVec2; 2]) -> usize {
    let scale = [&ring.source, &ring.target].map(|points| {
        let diameter = Bounds::of(points.iter().copied()).map_or(0.0, |b| b.diameter());
        if diameter > 0.0 { 1.0 / diameter } else { 0.0 }
    });
    let distance = |k: usize| {
        ring.source[k].distance(points[0]) * scale[0]
            + ring.target[k].distance(points[1]) * scale[1]
    };
    (0..ring.source.len())
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}
