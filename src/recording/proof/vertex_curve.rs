//! Curves along which vertices move in one time interval, in Bernstein form (Bézier curves).

use super::bernstein::{EPS, bernstein_basis};
use crate::geometry::DVec2;
use crate::recording::interval::RecordingInterval;

/// Curve along which one vertex moves during an interval or a part of it.
#[derive(Clone, Debug)]
pub(crate) struct VertexCurve {
    /// Bernstein coefficients of the curve: its control points.
    pub(crate) control_points: Vec<DVec2>,
    /// Bound on the error of each coordinate: the rounding of the recording as it is played plus
    /// that of the control points.
    pub(crate) error: f64,
}

/// Converts the polynomials of an interval to vertex curves.
pub(super) struct IntervalCurves<'a> {
    interval: &'a RecordingInterval,
    basis: Vec<Vec<f64>>,
    /// For each basis function, the largest absolute value of its Bernstein coefficients, for the
    /// bound on rounding errors.
    largest: Vec<f64>,
}

impl<'a> IntervalCurves<'a> {
    /// Prepares the conversion for an interval.
    pub(super) fn of(interval: &'a RecordingInterval) -> Self {
        let basis = bernstein_basis(interval.coefficient_count());
        let largest_coefficient = |own: &Vec<f64>| own.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        Self {
            interval,
            largest: basis.iter().map(largest_coefficient).collect(),
            basis,
        }
    }

    /// Returns the length of the time interval in t.
    pub(super) fn length(&self) -> f64 {
        self.interval.to - self.interval.from
    }

    /// Returns the polynomial degree of the curves.
    pub(super) fn degree(&self) -> usize {
        self.basis.len() + 1
    }

    /// Returns the curve of the vertex with the index `vertex` in the recording's blocks.
    pub(super) fn curve(&self, vertex: usize) -> VertexCurve {
        let degree = self.degree();
        let [begin, end] = self.interval.ends(vertex);
        let straight = |i: usize| begin.lerp(end, i as f64 / degree as f64);
        let mut at: Vec<DVec2> = (0..=degree).map(straight).collect();
        let mut scale = begin.abs().max(end.abs()).max_element();
        for (k, (own, largest)) in self.basis.iter().zip(&self.largest).enumerate() {
            let c = self.interval.coefficient(vertex, k);
            scale += c.abs().max_element() * (1.0 + largest);
            at.iter_mut().zip(own).for_each(|(at, own)| *at += c * *own);
        }
        [at[0], at[degree]] = [begin, end];
        // Half of the bound is for the rounding of the control points: one rounding for each term
        // of each sum, and some for the straight line and the basis. The other half is for the same
        // rounding in the recording as it is played.
        let error = (4 * degree + 16) as f64 * EPS * scale;
        VertexCurve {
            control_points: at,
            error,
        }
    }
}

impl VertexCurve {
    /// Splits the curve in the middle.
    pub(super) fn halves(&self) -> [Self; 2] {
        self.cut(0.5)
    }

    /// Splits the curve at the parameter `s` in [0, 1] by de Casteljau's algorithm.
    pub(super) fn cut(&self, s: f64) -> [Self; 2] {
        let (mut left, mut right) = (self.clone(), self.clone());
        let last = self.control_points.len() - 1;
        for k in 1..=last {
            for i in 0..=last - k {
                right.control_points[i] =
                    right.control_points[i] * (1.0 - s) + right.control_points[i + 1] * s;
            }
            left.control_points[k] = right.control_points[0];
        }
        let scale = self.control_points.iter().map(|p| p.abs().max_element());
        // Each step of the algorithm has at most three roundings.
        let error = self.error + (3 * last) as f64 * EPS * scale.fold(0.0, f64::max);
        [left.error, right.error] = [error; 2];
        [left, right]
    }

    /// Returns the lower left and the upper right corner of a box that contains the curve, error
    /// included.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        let first = [self.control_points[0]; 2];
        let [min, max] =
            (self.control_points.iter()).fold(first, |[a, b], p| [a.min(*p), b.max(*p)]);
        [min - self.error, max + self.error]
    }
}

/// Subtracts a common motion from all curves and returns it. The boxes of the curves are then as
/// small as if the drawing as a whole did not move.
///
/// The subtraction is exact. A coordinate x of a control point is changed only if the corresponding
/// coordinates of all curves lie within a factor of 2; m, the middle of their range, then satisfies
/// m / 2 ≤ x ≤ 2 m (P. H. Sterbenz, Floating-Point Computation, 1974, theorem 4.3.1).
pub(super) fn subtract_common_motion(curves: &mut [VertexCurve]) -> VertexCurve {
    let count = curves.first().map_or(1, |curve| curve.control_points.len());
    let common = |values: &mut dyn Iterator<Item = f64>| -> f64 {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (min, max) = values.fold(none, |(min, max), x| (min.min(x), max.max(x)));
        match (min > 0.0 && max <= 2.0 * min) || (max < 0.0 && min >= 2.0 * max) {
            true => min.midpoint(max),
            false => 0.0,
        }
    };
    let control_points = (0..count).map(|k| {
        let point = |curve: &VertexCurve| curve.control_points[k];
        let shift = DVec2::new(
            common(&mut curves.iter().map(|curve| point(curve).x)),
            common(&mut curves.iter().map(|curve| point(curve).y)),
        );
        for curve in &mut *curves {
            curve.control_points[k] -= shift;
        }
        shift
    });
    VertexCurve {
        control_points: control_points.collect(),
        error: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_common_motion_is_subtracted_exactly() {
        let curve = |offset: f64| VertexCurve {
            control_points: [0.0, -3e8, 1e9]
                .map(|travelled| DVec2::new(travelled + offset, 0.1 + offset))
                .to_vec(),
            error: 0.0,
        };
        let before = [curve(0.0), curve(0.7), curve(-0.3)];
        let mut after = before.clone();
        let common = subtract_common_motion(&mut after);
        for (before, after) in before.iter().zip(&after) {
            assert_eq!(
                before.control_points[0], after.control_points[0],
                "near zero"
            );
            for k in 0..3 {
                let restored = after.control_points[k] + common.control_points[k];
                assert_eq!(restored, before.control_points[k]);
                assert!(after.control_points[k].length() < 2.0, "{after:?}");
            }
        }
    }
}
