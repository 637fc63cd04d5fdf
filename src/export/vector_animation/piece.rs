//! Animation piece: a constant set of shapes between two values of t, with a Chebyshev series for
//! each point.

use crate::geometry::DVec2;

use super::chebyshev;
use super::shape::PosedShape;

/// A constant set of shapes between two values of t, which may be equal.
#[derive(Clone, Debug)]
pub(super) struct AnimationPiece {
    /// First t of the interval.
    pub from: f64,
    /// Last t of the interval.
    pub to: f64,
    /// Shapes in painting order, the lowest first.
    pub shapes: Vec<MovingShape>,
    /// Whether the shapes at the start are those at the end of the previous animation piece, in the
    /// same places.
    pub is_continuation: bool,
}

/// A shape and its motion over the interval of an animation piece.
#[derive(Clone, Debug)]
pub(super) struct MovingShape {
    /// The shape at the beginning of the interval.
    pub first: PosedShape,
    /// Chebyshev series of the points in the fraction s of the interval: element j holds, for each
    /// point, the coefficient of T_j(2s − 1).
    pub terms: Vec<Vec<DVec2>>,
    /// Appearances (colour, width and gradient numbers) at evenly spaced t from the beginning to
    /// the end of the interval. There is only one if the appearance is constant.
    pub appearances: Vec<Vec<f64>>,
}

impl AnimationPiece {
    /// Returns the shapes at `t`, which is clamped to the interval.
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
    /// Returns the shape at the fraction `s` in [0, 1] of the interval.
    pub(super) fn at(&self, s: f64) -> PosedShape {
        PosedShape {
            form: self.first.form.clone(),
            points: chebyshev::evaluate(&self.terms, s),
            appearance: self.appearance_at(s),
        }
    }

    /// Returns the appearance at the fraction `s` in [0, 1] of the interval, interpolated linearly.
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
