//! The match of two closed curves: a strictly monotone, piecewise linear mapping between their
//! places (fractions of arc length).

/// Mapping from the places (fractions of arc length) of one closed curve to those of another. It is
/// linear between knots, strictly monotone in both directions, and goes around once.
///
/// The match in the other direction is exactly [`Self::inverse`], without rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryMatch {
    /// Pairs of corresponding places `[source, target]`: ascending in the source, cyclically
    /// ascending in the target.
    pub(super) knots: Vec<[f64; 2]>,
    pub(super) rotation: f64,
    pub(super) cost: f64,
    pub(super) pins: Vec<[f64; 2]>,
}

impl BoundaryMatch {
    /// Returns the knots: pairs of corresponding places `[source, target]`. They ascend in the
    /// source and, up to a cyclic shift, in the target. There is at least one.
    #[must_use]
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// Returns the rotation of the source about its centre that best aligns it with the matched
    /// target (least squares), in radians in (−π, π].
    #[must_use]
    pub fn rotation(&self) -> f64 {
        self.rotation
    }

    /// Returns the dissimilarity of the matched curves, dimensionless: 0 for curves that are equal
    /// up to a similarity, up to about 0.3 for two poses of one shape, 0.4 and more for dissimilar
    /// shapes.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.cost
    }

    /// Returns the match in the other direction, from the target to the source. It is exact,
    /// without rounding.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let swapped = |pairs: &[[f64; 2]]| {
            let mut pairs: Vec<_> = pairs.iter().map(|&[s, t]| [t, s]).collect();
            pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
            pairs
        };
        // The inverse has the opposite rotation. A half turn stays π, because −π is outside
        // (−π, π].
        let is_half_turn = self.rotation == std::f64::consts::PI;
        Self {
            knots: swapped(&self.knots),
            rotation: if is_half_turn {
                self.rotation
            } else {
                0.0 - self.rotation
            },
            cost: self.cost,
            pins: swapped(&self.pins),
        }
    }
}

/// Interpolates linearly between knots: returns the value of column `there` at the point where
/// column `here` has the value `place`. The knots ascend in all columns.
///
/// If `place` lies before the first or after the last knot, returns the value of that knot.
pub(super) fn interpolate_knots<const N: usize>(
    knots: &[[f64; N]],
    place: f64,
    [here, there]: [usize; 2],
) -> f64 {
    let after = knots.partition_point(|knot| knot[here] <= place);
    // Places before the first or after the last knot use the first or the last interval.
    let k = after.clamp(1, knots.len() - 1);
    let (from, to) = (knots[k - 1], knots[k]);
    let along = (place - from[here]) / (to[here] - from[here]);
    let (start, end) = (from[there], to[there]);
    // At a knot, and beyond the first or the last one, return the knot's value without rounding.
    if along >= 1.0 {
        end
    } else {
        start + along.max(0.0) * (end - start)
    }
}
