//! The match of two curves: a strictly monotone map between their places.

use super::pins::Pin;

/// Which place of one curve is which of the other: linear between knots,
/// strictly monotone both ways, once around where the curves are closed.
///
/// The match the other way is exactly [`Self::inverse`], bit by bit.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryMatch {
    /// Ascending in the source, cyclically ascending in the target.
    pub(super) knots: Vec<[f64; 2]>,
    pub(super) closed: bool,
    pub(super) rotation: f64,
    pub(super) cost: f64,
    pub(super) pins: Vec<[f64; 2]>,
}

impl BoundaryMatch {
    /// Pairs of places that are the same point, `[source, target]`: ascending
    /// in the source, and from some knot on in the target. At least one if
    /// closed; the two ends and more if open.
    #[must_use]
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// The pins as they were honoured, ascending in the source.
    pub fn pins(&self) -> impl Iterator<Item = Pin> + '_ {
        let pin = |&[source, target]: &[f64; 2]| Pin { source, target };
        self.pins.iter().map(pin)
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

    /// Whether the curves are closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The match from the target to the source.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let swapped = |pairs: &[[f64; 2]]| {
            let mut pairs: Vec<_> = pairs.iter().map(|&[s, t]| [t, s]).collect();
            pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
            pairs
        };
        let half_turn = self.rotation == std::f64::consts::PI;
        Self {
            knots: swapped(&self.knots),
            closed: self.closed,
            rotation: if half_turn {
                self.rotation
            } else {
                0.0 - self.rotation
            },
            cost: self.cost,
            pins: swapped(&self.pins),
        }
    }

    /// The target's place that is the source's `place`, exact at knots. O(knots).
    ///
    /// ```
    /// use morphospace::correspondence::{MatchOptions, match_rings};
    /// use morphospace::geometry::{DVec2, Ring};
    /// let flag = [(0.0, 0.0), (3.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    /// let ring = Ring::new(flag.to_vec())?;
    /// let same = match_rings(&ring, &ring, &[], &MatchOptions::default())?;
    /// assert!((same.target_from_source(0.3) - 0.3).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn target_from_source(&self, place: f64) -> f64 {
        self.across(place, 0)
    }

    /// The source's place that is the target's `place`.
    #[must_use]
    pub fn source_from_target(&self, place: f64) -> f64 {
        self.across(place, 1)
    }

    fn across(&self, place: f64, side: usize) -> f64 {
        if let Some(knot) = self.knots.iter().find(|knot| knot[side] == place) {
            return knot[1 - side]; // exact, seams or not
        }
        let unrolled = self.unrolled(side);
        let first = unrolled[0][side];
        let place = if self.closed {
            first + (place - first).rem_euclid(1.0)
        } else {
            place.clamp(0.0, 1.0)
        };
        let found = interpolated(&unrolled, place, side);
        if !self.closed {
            return found;
        }
        let found = found.rem_euclid(1.0);
        if found < 1.0 { found } else { 0.0 }
    }

    /// The knots counted on over the seams, ascending on both sides; closed
    /// matches end with the first knot one round on.
    pub(super) fn unrolled(&self, side: usize) -> Vec<[f64; 2]> {
        let mut knots = self.knots.clone();
        if !self.closed {
            return knots;
        }
        let first = knots
            .iter()
            .enumerate()
            .min_by(|(_, a), (_, b)| a[side].total_cmp(&b[side]))
            .map_or(0, |(k, _)| k);
        knots.rotate_left(first);
        let mut rounds = [0.0; 2];
        let start = knots[0];
        let mut last = start;
        for knot in &mut knots {
            for s in 0..2 {
                if knot[s] < last[s] {
                    rounds[s] = 1.0;
                }
            }
            last = *knot;
            *knot = [knot[0] + rounds[0], knot[1] + rounds[1]];
        }
        knots.push(start.map(|place| place + 1.0));
        knots
    }
}

/// The other side's place, linear between knots ascending on both sides.
pub(super) fn interpolated(knots: &[[f64; 2]], place: f64, side: usize) -> f64 {
    let after = knots.partition_point(|knot| knot[side] <= place);
    let k = after.clamp(1, knots.len() - 1);
    let (from, to) = (knots[k - 1], knots[k]);
    let along = (place - from[side]) / (to[side] - from[side]);
    let (start, end) = (from[1 - side], to[1 - side]);
    if along >= 1.0 {
        end
    } else {
        start + along.max(0.0) * (end - start)
    }
}
