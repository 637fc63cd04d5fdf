//! Intrinsic interpolation of one ring (closed polygon).
//!
//! Sederberg, Gao, Wang, Mu, "2-D shape blending: an intrinsic solution to the vertex path problem"
//! (1993), §3 and §4: the lengths and directions of the edges are interpolated. The resulting
//! polygon has a gap. To close the gap, the length of each edge is changed by S, such that Σ (S/w)²
//! is minimal. The weight is w = max(|L_A − L_B|, tolerance), where L_A and L_B are the lengths of
//! the edge in the two designs. The changes follow from two Lagrange multipliers, the solution of a
//! 2×2 system.
//!
//! Guaranteed: a closed, finite ring at every finite t. Similar rings stay similar. Exchanging the
//! rings mirrors the motion in time. Not guaranteed: that the ring does not cross itself.

use super::turning::{self, edges};
use crate::geometry::{DMat2, DVec2};

/// Minimum of an edge's weight w, as a fraction of its mean length.
///
/// Sederberg et al. (1993) use 1e-4 of the largest length change. With so small a value, the end
/// edge of a bending arm, which is equally long in both designs, could hardly change; the sides of
/// the arm would shrink to nothing in order to close a gap across it (heuristic).
const MIN_RELATIVE_CHANGE: f64 = 0.1;

/// Regularisation of the 2×2 system, as a fraction of its trace (tolerance: parallel edges make
/// the system singular, as they cannot close a gap across their direction).
const RIDGE: f64 = 1e-12;

/// A ring as edge lengths and directions in source and target.
#[derive(Clone, Debug)]
pub(super) struct IntrinsicRing {
    edges: Vec<IntrinsicEdge>,
}

/// An edge and its start vertex.
#[derive(Clone, Copy, Debug)]
struct IntrinsicEdge {
    /// Length of the edge in source and target.
    lengths: [f64; 2],
    /// Direction of the edge in the source, in radians.
    angle: f64,
    /// Rotation of the edge from source to target, in radians.
    turn: f64,
    /// Compliance of the edge's length: the square of the weight w (see the module), relative to
    /// the largest w² of the ring.
    freedom: f64,
    /// Mass of the start vertex as a fraction of the ring's mass: half the length of the two
    /// adjacent edges, averaged over both designs.
    mass: f64,
    /// Length of the ring from its first vertex to the start vertex, as a fraction of the ring's
    /// whole length.
    before: f64,
}

impl IntrinsicRing {
    /// Creates a ring from its vertices in source and target: computes the lengths and directions
    /// of its edges.
    ///
    /// `default_turn` is the rotation, in radians, of all edges if no edge has a direction in
    /// both designs.
    pub(super) fn new(source: &[DVec2], target: &[DVec2], default_turn: f64) -> Self {
        let lengths: Vec<[f64; 2]> = edges(source)
            .zip(edges(target))
            .map(|(a, b)| [a.length(), b.length()])
            .collect();
        let shares = shares(&lengths);
        let freedoms = freedoms(&lengths);
        let turns = turning::turns(source, target, default_turn);
        let last = shares.len() - 1;
        let mut before = 0.0;
        let edge = |k: usize| {
            let begin = before;
            before += shares[k];
            IntrinsicEdge {
                lengths: lengths[k],
                angle: turns[k][0],
                turn: turns[k][1],
                freedom: freedoms[k],
                mass: shares[k].midpoint(shares[if k == 0 { last } else { k - 1 }]),
                before: begin,
            }
        };
        Self {
            edges: (0..=last).map(edge).collect(),
        }
    }

    /// Returns the number of vertices.
    pub(super) fn len(&self) -> usize {
        self.edges.len()
    }

    /// Returns the masses of the vertices, which do not depend on t and sum to 1.
    pub(super) fn masses(&self) -> impl Iterator<Item = f64> + '_ {
        self.edges.iter().map(|edge| edge.mass)
    }

    /// Returns the length-weighted mean rotation of the edges in radians.
    fn mean_turn(&self) -> f64 {
        let ends = self
            .edges
            .iter()
            .skip(1)
            .map(|edge| edge.before)
            .chain([1.0]);
        let shares = self.edges.iter().zip(ends);
        shares
            .map(|(edge, end)| edge.turn * (end - edge.before))
            .sum()
    }

    /// Adds whole turns to all edges so that the mean rotation is nearest to `angle` in radians.
    pub(super) fn choose_whole_turns(&mut self, angle: f64) {
        let added = turning::whole_turns(self.mean_turn(), angle);
        self.edges.iter_mut().for_each(|edge| edge.turn += added);
    }

    /// Returns the rotation at a vertex in radians: the mean rotation of its two edges.
    pub(super) fn turn_at(&self, vertex: usize) -> f64 {
        let before = vertex.checked_sub(1).unwrap_or(self.len() - 1);
        self.edges[before].turn.midpoint(self.edges[vertex].turn)
    }

    /// Writes the vertices at t, with their centroid at the origin.
    pub(super) fn write(&self, t: f64, out: &mut [DVec2]) {
        // `out` first holds the edge directions, which saves an allocation.
        let (mut gap, mut xx, mut xy, mut yy) = (DVec2::ZERO, 0.0, 0.0, 0.0);
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            let along = DVec2::from_angle(edge.angle + t * edge.turn);
            gap += edge.length(t) * along;
            xx += edge.freedom * along.x * along.x;
            xy += edge.freedom * along.x * along.y;
            yy += edge.freedom * along.y * along.y;
            *out = along;
        }
        let multiplier = multipliers([xx, xy, yy], gap);
        let (mut end, mut centre) = (DVec2::ZERO, DVec2::ZERO);
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            let along = *out;
            *out = end;
            end += (edge.length(t) - edge.freedom * multiplier.dot(along)) * along;
        }
        // Rounding, or edges that are all parallel, leave a gap `end`, which is distributed
        // along the ring.
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            *out -= edge.before * end;
            centre += edge.mass * *out;
        }
        out.iter_mut().for_each(|p| *p -= centre);
    }
}

impl IntrinsicEdge {
    /// Returns the edge's length at t before the gap of the ring is closed: the linear
    /// interpolation between its lengths in the designs.
    fn length(&self, t: f64) -> f64 {
        self.lengths[0] * (1.0 - t) + self.lengths[1] * t
    }
}

/// Returns the Lagrange multipliers that close the gap of a ring, as far as the edge directions
/// permit. The array holds the entries of the symmetric 2×2 matrix of the system.
fn multipliers([xx, xy, yy]: [f64; 3], gap: DVec2) -> DVec2 {
    let ridge = RIDGE * (xx + yy);
    if ridge <= 0.0 {
        return DVec2::ZERO;
    }
    let (xx, yy) = (xx + ridge, yy + ridge);
    let adjugate = DMat2::from_cols(DVec2::new(yy, -xy), DVec2::new(-xy, xx));
    // The ridge bounds the determinant from below by ridge · trace.
    adjugate * gap / (xx * yy - xy * xy).max(ridge * (xx + yy))
}

/// Returns each edge's fraction of the ring's length, averaged over both designs.
///
/// A design in which the ring is a point is ignored; if it is a point in both, all edges have
/// equal fractions.
fn shares(lengths: &[[f64; 2]]) -> Vec<f64> {
    let totals = [0, 1].map(|side| lengths.iter().map(|l| l[side]).sum::<f64>());
    let equal_share = 1.0 / lengths.len() as f64;
    let mean_share = |l: &[f64; 2]| {
        let share_in = |side: usize| {
            let share = l[side] / totals[side];
            share.is_finite().then_some(share)
        };
        match [share_in(0), share_in(1)] {
            [Some(a), Some(b)] => a.midpoint(b),
            [a, b] => a.or(b).unwrap_or(equal_share),
        }
    };
    lengths.iter().map(mean_share).collect()
}

/// Returns the compliance of each edge, the square of its weight w (see the module), relative to
/// the largest compliance of the ring.
///
/// An edge that has no length in either design keeps length zero.
fn freedoms(lengths: &[[f64; 2]]) -> Vec<f64> {
    let change = |[a, b]: &[f64; 2]| (a - b).abs().max(MIN_RELATIVE_CHANGE * a.midpoint(*b));
    let max_change = lengths.iter().map(change).fold(0.0, f64::max);
    let freedom = |l: &[f64; 2]| {
        if max_change > 0.0 {
            (change(l) / max_change).powi(2)
        } else {
            0.0
        }
    };
    lengths.iter().map(freedom).collect()
}
