//! One ring between two, by its edges.
//!
//! Sederberg, Gao, Wang, Mu, "2-D shape blending: an intrinsic solution to the
//! vertex path problem" (1993), §3 and §4: lengths and directions of the edges
//! are interpolated, and the gap that is left is closed by changes S of the
//! lengths with least Σ (S/w)², w = max(|L_A − L_B|, a tolerance), with two
//! Lagrange multipliers and thus a 2×2 system.
//!
//! Guaranteed: a closed, finite ring at every finite t; rings that are
//! similar stay so; the rings exchanged give the same at 1 − t. Not
//! guaranteed: that the ring does not cross itself.

use super::turning::{self, edges};
use crate::geometry::{DMat2, DVec2};

/// An edge may change its length by at least this share of its mean. The
/// paper's tolerance, 1e-4 of the largest change, lets the edges of an arm
/// that bends shrink to nothing sooner than it lets the arm's flat end, as
/// wide in both designs, take up a gap across the arm.
const LEAST_CHANGE: f64 = 0.1;

/// Added to the system, as a share of its trace. Edges that all run in one
/// direction cannot close a gap across it.
const RIDGE: f64 = 1e-12;

/// A ring in source and target, as edges.
#[derive(Clone, Debug)]
pub(super) struct IntrinsicRing {
    edges: Vec<IntrinsicEdge>,
}

/// An edge and the vertex that it begins at.
#[derive(Clone, Copy, Debug)]
struct IntrinsicEdge {
    /// In source and target.
    lengths: [f64; 2],
    /// Direction in the source, in radians.
    angle: f64,
    /// By how much it turns, in radians.
    turn: f64,
    /// How freely its length changes: w², 1 for the freest edge.
    freedom: f64,
    /// The vertex's share of the ring's mass: the half of either edge that it
    /// ends, in both designs.
    mass: f64,
    /// The share of the ring's length that lies before the vertex.
    before: f64,
}

impl IntrinsicRing {
    /// Takes the rings apart; `otherwise` is the turn of rings of which one is
    /// a point.
    pub(super) fn new(source: &[DVec2], target: &[DVec2], otherwise: f64) -> Self {
        let lengths: Vec<[f64; 2]> = edges(source)
            .zip(edges(target))
            .map(|(a, b)| [a.length(), b.length()])
            .collect();
        let shares = shares(&lengths);
        let freedoms = freedoms(&lengths);
        let turns = turning::turns(source, target, otherwise);
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

    /// How many vertices there are.
    pub(super) fn len(&self) -> usize {
        self.edges.len()
    }

    /// The fixed masses of the vertices; their sum is 1.
    pub(super) fn masses(&self) -> impl Iterator<Item = f64> + '_ {
        self.edges.iter().map(|edge| edge.mass)
    }

    /// The mean turn of the edges, by their share of the length, in radians.
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

    /// Adds the whole turns to all edges that bring their mean nearest to an
    /// angle, in radians.
    pub(super) fn turn_near(&mut self, angle: f64) {
        let more = turning::whole_turns(self.mean_turn(), angle);
        self.edges.iter_mut().for_each(|edge| edge.turn += more);
    }

    /// The turn about a vertex: the mean of its two edges', in radians.
    pub(super) fn turn_at(&self, vertex: usize) -> f64 {
        let before = vertex.checked_sub(1).unwrap_or(self.len() - 1);
        self.edges[before].turn.midpoint(self.edges[vertex].turn)
    }

    /// Writes the vertices at t, their centroid in the origin.
    pub(super) fn write(&self, t: f64, out: &mut [DVec2]) {
        // Directions first stand where the vertices will.
        let (mut gap, mut xx, mut xy, mut yy) = (DVec2::ZERO, 0.0, 0.0, 0.0);
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            let along = DVec2::from_angle(edge.angle + t * edge.turn);
            gap += edge.length(t) * along;
            xx += edge.freedom * along.x * along.x;
            xy += edge.freedom * along.x * along.y;
            yy += edge.freedom * along.y * along.y;
            *out = along;
        }
        let multiplier = solved([xx, xy, yy], gap);
        let (mut at, mut centre) = (DVec2::ZERO, DVec2::ZERO);
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            let along = *out;
            *out = at;
            at += (edge.length(t) - edge.freedom * multiplier.dot(along)) * along;
        }
        // What is left of the gap, by rounding or because all edges run one
        // way, is shared out along the ring.
        for (edge, out) in self.edges.iter().zip(&mut *out) {
            *out -= edge.before * at;
            centre += edge.mass * *out;
        }
        out.iter_mut().for_each(|p| *p -= centre);
    }
}

impl IntrinsicEdge {
    fn length(&self, t: f64) -> f64 {
        self.lengths[0] * (1.0 - t) + self.lengths[1] * t
    }
}

/// The multipliers that close a gap as far as the edges' directions can.
fn solved([xx, xy, yy]: [f64; 3], gap: DVec2) -> DVec2 {
    let ridge = RIDGE * (xx + yy);
    if ridge <= 0.0 {
        return DVec2::ZERO;
    }
    let (xx, yy) = (xx + ridge, yy + ridge);
    let adjugate = DMat2::from_cols(DVec2::new(yy, -xy), DVec2::new(-xy, xx));
    // With the ridge the determinant is at least ridge · trace.
    adjugate * gap / (xx * yy - xy * xy).max(ridge * (xx + yy))
}

/// Each edge's share of the length, the mean of both designs'; even where
/// there is no length.
fn shares(lengths: &[[f64; 2]]) -> Vec<f64> {
    let totals = [0, 1].map(|side| lengths.iter().map(|l| l[side]).sum::<f64>());
    let even = 1.0 / lengths.len() as f64;
    let share = |l: &[f64; 2]| {
        let of = |side: usize| {
            let share = l[side] / totals[side];
            share.is_finite().then_some(share)
        };
        match [of(0), of(1)] {
            [Some(a), Some(b)] => a.midpoint(b),
            [a, b] => a.or(b).unwrap_or(even),
        }
    };
    lengths.iter().map(share).collect()
}

/// How freely each edge changes its length. What has none stays so.
fn freedoms(lengths: &[[f64; 2]]) -> Vec<f64> {
    let change = |[a, b]: &[f64; 2]| (a - b).abs().max(LEAST_CHANGE * a.midpoint(*b));
    let most = lengths.iter().map(change).fold(0.0, f64::max);
    let of = |l: &[f64; 2]| {
        if most > 0.0 {
            (change(l) / most).powi(2)
        } else {
            0.0
        }
    };
    lengths.iter().map(of).collect()
}
