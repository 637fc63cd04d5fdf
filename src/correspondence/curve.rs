//! Closed curves parametrised by arc length, with the unwrapped direction of their tangent.
//!
//! A *place* on a [`BoundaryCurve`] is an arc-length position: the fraction of the curve's length
//! from its first point, in [0, 1). It does not change when the curve is translated, rotated or
//! scaled.
//!
//! *Turning* at a place is the mean direction after it minus the mean direction before it, both
//! over a given length of the curve. Means of the *unwrapped* direction have no jump at ±π, and
//! jitter of the outline cancels out.

use crate::geometry::{DVec2, Ring, nearest_segment_parameter, perimeter};
use std::f64::consts::TAU;

/// Smallest change of direction at a vertex that counts as a bend, in radians (tolerance: far below
/// one pixel over a screen's width; straight lines with coordinates rounded to seven digits still
/// count as straight).
const MIN_BEND: f64 = 1e-5;

/// A closed polyline parametrised by arc length.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryCurve {
    points: Vec<DVec2>,
    /// Place of each point (fraction of the curve's length), followed by 1.
    places: Vec<f64>,
    /// Unwrapped direction of each edge, in radians: multiples of 2π are added so that it changes
    /// by at most π from edge to edge.
    directions: Vec<f64>,
    /// Integral of the unwrapped direction with respect to the place: from place 0 to each point,
    /// and to place 1.
    integral: Vec<f64>,
    /// Change of the unwrapped direction once around the curve, in radians: 2π times the turning
    /// number.
    round: f64,
}

/// Error: the length of a ring overflows or underflows floating point.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the outline is too large or too small to measure; scale it to an ordinary size")]
pub struct CurveLengthError;

impl BoundaryCurve {
    /// Creates the curve along a closed boundary, in the ring's direction.
    ///
    /// # Errors
    /// [`CurveLengthError`] if the ring's length overflows or underflows.
    ///
    /// ```
    /// use morphospace::{correspondence::BoundaryCurve, geometry::{DVec2, Ring}};
    /// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    /// let curve = BoundaryCurve::closed(&Ring::new(square.to_vec())?)?;
    /// assert_eq!(curve.point_at(0.625), DVec2::new(0.5, 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn closed(ring: &Ring) -> Result<Self, CurveLengthError> {
        let edges = unit_edges(ring).ok_or(CurveLengthError)?;
        let mut places = vec![0.0];
        let mut length = 0.0;
        for edge in &edges {
            length += edge.length();
            places.push(length);
        }
        if !(length.is_finite() && length > 0.0) {
            return Err(CurveLengthError);
        }
        places.iter_mut().for_each(|place| *place /= length);
        let directions = unwrapped_directions(&edges);
        let mut integral = vec![0.0];
        for (e, direction) in directions.iter().enumerate() {
            integral.push(integral[e] + direction * (places[e + 1] - places[e]));
        }
        let (first, last) = (edges[0], edges[edges.len() - 1]);
        let total_turning =
            directions[edges.len() - 1] + exterior_angle(last, first) - directions[0];
        Ok(Self {
            round: TAU * (total_turning / TAU).round(),
            points: ring.points().to_vec(),
            places,
            directions,
            integral,
        })
    }

    /// Returns the curve's vertices in order.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Returns the place of each vertex, a fraction of the curve's length from its first point. The
    /// places are in order and do not decrease.
    #[must_use]
    pub fn places(&self) -> &[f64] {
        &self.places[..self.points.len()]
    }

    /// Returns whether the curve bends at its `point`-th vertex by more than rounding error.
    pub(super) fn bends_at(&self, point: usize) -> bool {
        let before = match point {
            0 => self.directions[self.directions.len() - 1] - self.round,
            _ => self.directions[point - 1],
        };
        (self.directions[point] - before).abs() > MIN_BEND
    }

    /// Returns the point at a place, a fraction of the curve's length from its first point, taken
    /// modulo 1. At the curve's vertices, the result is exact.
    #[must_use]
    pub fn point_at(&self, place: f64) -> DVec2 {
        let place = self.wrapped(place);
        let e = self.edge_at(place);
        let (from, to) = (self.points[e], self.points[(e + 1) % self.points.len()]);
        let along = (place - self.places[e]) / (self.places[e + 1] - self.places[e]);
        // On an edge of zero length the ratio is NaN. Both comparisons then fail, and the first
        // point of the edge is returned.
        if along >= 1.0 {
            return to;
        }
        if along > 0.0 {
            from.lerp(to, along)
        } else {
            from
        }
    }

    /// Returns the derivative of [`Self::point_at`] with respect to the place: the edge's unit
    /// direction times the curve's length. It is zero on edges of zero length.
    pub(crate) fn velocity_at(&self, place: f64) -> DVec2 {
        let e = self.edge_at(self.wrapped(place));
        let (from, to) = (self.points[e], self.points[(e + 1) % self.points.len()]);
        let place_span = self.places[e + 1] - self.places[e];
        if place_span > 0.0 {
            (to - from) / place_span
        } else {
            DVec2::ZERO
        }
    }

    /// Returns the place (fraction of the curve's length) of the curve's point that is nearest to
    /// `p`, for example to put a pin on the curve. Among several nearest points, the first one
    /// counts.
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for e in 0..self.directions.len() {
            best = self.closer_candidate(best, p, e, [0.0, 1.0]);
        }
        self.wrapped(best.1)
    }

    /// Finds the point nearest to `p` on the section of the curve from place `from` to place `to`.
    /// Returns its place, in [0, 1), and its distance from `p`. `from` and `to` may be negative or
    /// exceed 1. Requires `from <= to`; at most one full turn around the curve is searched.
    pub(super) fn nearest_within(&self, p: DVec2, from: f64, to: f64) -> (f64, f64) {
        let to = to.min(from + 1.0);
        let mut best = (f64::INFINITY, self.wrapped(from));
        let count = self.directions.len();
        let mut base = from.floor();
        let mut e = self.edge_at(from - base);
        while base + self.places[e] <= to {
            let [start, end] = [self.places[e], self.places[e + 1]].map(|place| base + place);
            let fraction = |place: f64| ((place - start) / (end - start)).clamp(0.0, 1.0);
            if end > start {
                best = self.closer_candidate(best, p, e, [fraction(from), fraction(to)]);
            }
            e += 1;
            if e == count {
                (e, base) = (0, base + 1.0);
            }
        }
        (self.wrapped(best.1), best.0.sqrt())
    }

    /// Returns the candidate nearer to `p`: `best`, or the nearest point of edge `e` between the
    /// fractions `low` and `high` of the edge. A candidate is a squared distance from `p` and a
    /// place.
    fn closer_candidate(
        &self,
        best: (f64, f64),
        p: DVec2,
        e: usize,
        [low, high]: [f64; 2],
    ) -> (f64, f64) {
        let (from, to) = (self.points[e], self.points[(e + 1) % self.points.len()]);
        let along = nearest_segment_parameter(p, from, to).clamp(low, high);
        let distance = p.distance_squared(from.lerp(to, along));
        if distance < best.0 {
            let [start, end] = [self.places[e], self.places[e + 1]];
            (distance, start + along * (end - start))
        } else {
            best
        }
    }

    /// Returns the length of the curve, in the units of the points. It may overflow for huge
    /// coordinates.
    pub(super) fn length(&self) -> f64 {
        perimeter(&self.points)
    }

    /// Returns the number of turns of the tangent: 1 for simple counter-clockwise boundaries, −1
    /// for clockwise ones.
    pub(super) fn turning_number(&self) -> i32 {
        (self.round / TAU).round() as i32
    }

    /// Returns `place` modulo 1, in [0, 1).
    pub(crate) fn wrapped(&self, place: f64) -> f64 {
        let place = place.rem_euclid(1.0);
        if place < 1.0 { place } else { 0.0 } // rem_euclid rounds -1e-20 up to 1
    }

    /// Returns the mean direction of the tangent between two places, in radians, unwrapped (without
    /// jumps of 2π). The places may lie outside [0, 1).
    pub(super) fn direction(&self, from: f64, to: f64) -> f64 {
        (self.direction_integral(to) - self.direction_integral(from)) / (to - from)
    }

    /// Returns the turning at a place, in radians: the mean direction over the length `reach` after
    /// the place, minus the mean direction over the same length before it.
    pub(super) fn turning(&self, place: f64, reach: f64) -> f64 {
        self.direction(place, place + reach) - self.direction(place - reach, place)
    }

    /// Returns the integral of the tangent's direction, unwrapped (without jumps of 2π), from place
    /// 0 to `place`, which may lie outside [0, 1).
    fn direction_integral(&self, place: f64) -> f64 {
        let rounds = place.floor();
        let partial = place - rounds;
        let whole = rounds * self.integral[self.directions.len()];
        // On trip k around the curve, the direction is larger by k · `round` than on trip 0. The
        // complete trips have k = 0, 1, …, rounds − 1, with the sum 0.5 · rounds · (rounds − 1).
        // The last, incomplete trip has k = rounds and the length `partial`.
        let full_rounds = self.round * rounds * (partial + 0.5 * (rounds - 1.0));
        whole + full_rounds + self.integral_within(partial)
    }

    /// Returns the integral of the tangent's direction, unwrapped (without jumps of 2π), from place
    /// 0 to a place in [0, 1].
    fn integral_within(&self, place: f64) -> f64 {
        let e = self.edge_at(place);
        self.integral[e] + self.directions[e] * (place - self.places[e])
    }

    /// Returns the index of the last edge that starts at or before a place in [0, 1].
    pub(super) fn edge_at(&self, place: f64) -> usize {
        let after = self.places.partition_point(|&start| start <= place);
        after.clamp(1, self.directions.len()) - 1
    }
}

/// Returns the edge vectors divided by the longer side of the ring's bounding box, so that squares
/// neither overflow nor underflow. Returns `None` if that side is zero or not finite.
fn unit_edges(ring: &Ring) -> Option<Vec<DVec2>> {
    let extent = ring.bounds().size().max_element();
    let is_measurable = extent.is_finite() && extent > 0.0;
    is_measurable.then(|| ring.edges().map(|(a, b)| (b - a) / extent).collect())
}

/// Returns the direction of each edge in radians, each within π of the previous one.
fn unwrapped_directions(edges: &[DVec2]) -> Vec<f64> {
    let mut direction = edges[0].to_angle();
    let mut directions = vec![direction];
    for pair in edges.windows(2) {
        direction += exterior_angle(pair[0], pair[1]);
        directions.push(direction);
    }
    directions
}

/// Returns the exterior angle between two edges in (−π, π]; 0 if one has zero length.
fn exterior_angle(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}
