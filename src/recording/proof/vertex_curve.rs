//! Where vertices are in a reel, as polynomials in Bernstein's form.

use super::bernstein::{EPS, bernstein_basis};
use crate::geometry::DVec2;
use crate::recording::interval::RecordingInterval;

/// The way of one vertex through a part of a reel.
#[derive(Clone, Debug)]
pub(super) struct VertexCurve {
    /// Its coefficients.
    pub(super) at: Vec<DVec2>,
    /// Neither the film as it is played nor a coefficient is further off: no
    /// coordinate by more.
    pub(super) error: f64,
}

/// Turns what a reel keeps into ways.
pub(super) struct IntervalCurves<'a> {
    reel: &'a RecordingInterval,
    basis: Vec<Vec<f64>>,
    /// The largest coefficient of each function of the basis.
    largest: Vec<f64>,
}

impl<'a> IntervalCurves<'a> {
    pub(super) fn of(reel: &'a RecordingInterval) -> Self {
        let basis = bernstein_basis(reel.coefficient_count());
        let most = |own: &Vec<f64>| own.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        Self {
            reel,
            largest: basis.iter().map(most).collect(),
            basis,
        }
    }

    /// How much of the film the reel is.
    pub(super) fn length(&self) -> f64 {
        self.reel.to - self.reel.from
    }

    pub(super) fn degree(&self) -> usize {
        self.basis.len() + 1
    }

    /// The way of a vertex, by its number in the film.
    pub(super) fn way(&self, vertex: usize) -> VertexCurve {
        let degree = self.degree();
        let [begin, end] = self.reel.ends(vertex);
        let straight = |i: usize| begin.lerp(end, i as f64 / degree as f64);
        let mut at: Vec<DVec2> = (0..=degree).map(straight).collect();
        let mut scale = begin.abs().max(end.abs()).max_element();
        for (k, (own, largest)) in self.basis.iter().zip(&self.largest).enumerate() {
            let c = self.reel.coefficient(vertex, k);
            scale += c.abs().max_element() * (1.0 + largest);
            at.iter_mut().zip(own).for_each(|(at, own)| *at += c * *own);
        }
        [at[0], at[degree]] = [begin, end];
        // Of each sum as many roundings as it has terms, a few for the straight line
        // and for the basis; and the same for the film that is played.
        let error = (4 * degree + 16) as f64 * EPS * scale;
        VertexCurve { at, error }
    }
}

impl VertexCurve {
    /// Both halves.
    pub(super) fn halves(&self) -> [Self; 2] {
        self.cut(0.5)
    }

    /// What is before a place in it, and what is after.
    pub(super) fn cut(&self, s: f64) -> [Self; 2] {
        let (mut left, mut right) = (self.clone(), self.clone());
        let last = self.at.len() - 1;
        for k in 1..=last {
            for i in 0..=last - k {
                right.at[i] = right.at[i] * (1.0 - s) + right.at[i + 1] * s;
            }
            left.at[k] = right.at[0];
        }
        let scale = self.at.iter().map(|p| p.abs().max_element());
        // Three roundings a step at most.
        let error = self.error + (3 * last) as f64 * EPS * scale.fold(0.0, f64::max);
        [left.error, right.error] = [error; 2];
        [left, right]
    }

    /// The box around it.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        let first = [self.at[0]; 2];
        let [min, max] = (self.at.iter()).fold(first, |[a, b], p| [a.min(*p), b.max(*p)]);
        [min - self.error, max + self.error]
    }
}
