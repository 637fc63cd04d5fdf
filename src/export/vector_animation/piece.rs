//! Pieces of a motion: the same shapes between two times, each point with a series.

use crate::geometry::DVec2;

use super::chebyshev;
use super::shape::PosedShape;

/// The shapes between two times, which may be one.
#[derive(Clone, Debug)]
pub(super) struct AnimationPiece {
    pub from: f64,
    pub to: f64,
    /// The lowest first.
    pub shapes: Vec<MovingShape>,
    /// Whether it goes on with the shapes of the piece before.
    pub goes_on: bool,
}

/// A shape within a piece.
#[derive(Clone, Debug)]
pub(super) struct MovingShape {
    /// As it is at the beginning.
    pub first: PosedShape,
    /// The series of its points, term by term.
    pub terms: Vec<Vec<DVec2>>,
    /// Its looks at even times from the beginning to the end, at least one.
    pub looks: Vec<Vec<f64>>,
}

impl AnimationPiece {
    /// The shapes at `t`; outside the piece as at its nearer end.
    pub(super) fn at(&self, t: f64) -> Vec<PosedShape> {
        let length = self.to - self.from;
        let s = if length > 0.0 {
            ((t - self.from) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.shapes.iter().map(|shape| shape.at(s)).collect()
    }
}

impl MovingShape {
    /// At `s` in [0, 1] of its piece.
    pub(super) fn at(&self, s: f64) -> PosedShape {
        PosedShape {
            form: self.first.form.clone(),
            points: chebyshev::evaluate(&self.terms, s),
            look: self.look_at(s),
        }
    }

    fn look_at(&self, s: f64) -> Vec<f64> {
        let last = self.looks.len() - 1;
        let at = s * last as f64;
        let k = (at as usize).min(last.saturating_sub(1));
        let (a, b) = (&self.looks[k], &self.looks[(k + 1).min(last)]);
        let share = at - k as f64;
        let mix = |(a, b): (&f64, &f64)| a * (1.0 - share) + b * share;
        a.iter().zip(b).map(mix).collect()
    }
}
