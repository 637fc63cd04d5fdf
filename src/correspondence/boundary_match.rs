//! The match of two curves: a strictly monotone map between their places.

/// Which place of one curve is which of the other: linear between knots,
/// strictly monotone both ways, once around.
///
/// The match the other way is exactly [`Self::inverse`], bit by bit.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryMatch {
    /// Ascending in the source, cyclically ascending in the target.
    pub(super) knots: Vec<[f64; 2]>,
    pub(super) rotation: f64,
    pub(super) cost: f64,
    pub(super) pins: Vec<[f64; 2]>,
}

impl BoundaryMatch {
    /// Pairs of places that are the same point, `[source, target]`: ascending
    /// in the source, and from some knot on in the target. At least one.
    #[must_use]
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// The rotation that lays the matched source onto the target, least
    /// squares about the centres, in radians in (−π, π].
    #[must_use]
    pub fn rotation(&self) -> f64 {
        self.rotation
    }

    /// How unlike the curves are as matched: 0 for similar ones, some tenths
    /// for two poses of a thing, no unit.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.cost
    }

    /// The match from the target to the source.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let swapped = |pairs: &[[f64; 2]]| {
            let mut pairs: Vec<_> = pairs.iter().map(|&[s, t]| [t, s]).collect();
            pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
            pairs
        };
        // −π is no rotation in (−π, π].
        let half_turn = self.rotation == std::f64::consts::PI;
        Self {
            knots: swapped(&self.knots),
            rotation: if half_turn {
                self.rotation
            } else {
                0.0 - self.rotation
            },
            cost: self.cost,
            pins: swapped(&self.pins),
        }
    }
}

/// Column `there` of knots that ascend in all columns, where column `here` is
/// at a place: linear between knots.
pub(super) fn interpolated<const N: usize>(
    knots: &[[f64; N]],
    place: f64,
    [here, there]: [usize; 2],
) -> f64 {
    let after = knots.partition_point(|knot| knot[here] <= place);
    // A place before the first knot, or behind the last, is by the nearest two.
    let k = after.clamp(1, knots.len() - 1);
    let (from, to) = (knots[k - 1], knots[k]);
    let along = (place - from[here]) / (to[here] - from[here]);
    let (start, end) = (from[there], to[there]);
    // What lies beyond a knot, by rounding or at an end, is at it to the last
    // bit.
    if along >= 1.0 {
        end
    } else {
        start + along.max(0.0) * (end - start)
    }
}
