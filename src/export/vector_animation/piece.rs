//! Pieces of a vector animation: a constant set of shapes between two times, with a Chebyshev
//! series for each point.

use crate::geometry::DVec2;

use super::chebyshev;
use super::shape::PosedShape;

/// A constant set of shapes between two values of t, which may be equal.
#[derive(Clone, Debug)]
pub(super) struct AnimationPiece {
    /// First t of the piece.
    pub from: f64,
    /// Last t of the piece.
    pub to: f64,
    /// Shapes in painting order, the lowest first.
    pub shapes: Vec<MovingShape>,
    /// Whether the piece begins with the shapes of the previous piece, in the same places.
    pub is_continuation: bool,
}

/// A shape and its motion from the first to the last t of a piece.
#[derive(Clone, Debug)]
pub(super) struct MovingShape {
    /// The shape at the beginning of the piece.
    pub first: PosedShape,
    /// Chebyshev coefficients of the shape's points, term by term.
    pub terms: Vec<Vec<DVec2>>,
    /// Appearances (colour, width and gradient numbers) at evenly spaced t from the beginning to
    /// the end of the piece. There is only one if the appearance is constant.
    pub appearances: Vec<Vec<f64>>,
}

impl AnimationPiece {
    /// Returns the shapes at `t`. Outside the piece, returns those of its nearer end.
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
    /// Returns the shape at the fraction `s` of its piece, in [0, 1].
    pub(super) fn at(&self, s: f64) -> PosedShape {
        PosedShape {
            form: self.first.form.clone(),
            points: chebyshev::evaluate(&self.terms, s),
            appearance: self.appearance_at(s),
        }
    }

    /// Returns the appearance at the fraction `s` of the piece, interpolated linearly.
    fn appearance_at(&self, s: f64) -> Vec<f64> {
        let last = self.appearances.len() - 1;
        let position = s * last as f64;
        let k = (position as usize).min(last.saturating_sub(1));
        let (a, b) = (&self.appearances[k], &self.appearances[(k + 1).min(last)]);
        let fraction = position - k as f64;
        let mix = |(a, b): (&f64, &f64)| a * (1.0 - fraction) + b * fraction;
        a.iter().zip(b).map(mix).collect()
    }
}
