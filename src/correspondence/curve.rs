//! Closed curves by arc length, with the unwrapped direction of their tangent.
//!
//! A place on a [`BoundaryCurve`] is the fraction of its length from the first point,
//! in [0, 1); so it keeps its meaning when the curve is moved, turned or
//! enlarged.
//!
//! Turning is the mean direction after a place less the mean direction before
//! it, both over a stated length of the curve. Means over the *unwrapped*
//! direction know no jump at ±π, and jitter of the outline cancels in them.

use crate::geometry::{DVec2, Ring, nearest_segment_parameter, perimeter};
use std::f64::consts::TAU;

/// A bend below this is none, in radians: a pixel over the width of twenty
/// thousand screens; coordinates with seven digits are straight to it.
const LEAST_BEND: f64 = 1e-5;

/// A closed polyline that knows its places by arc length.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryCurve {
    points: Vec<DVec2>,
    /// Place of each point, and at the end the place 1.
    places: Vec<f64>,
    /// Unwrapped direction of each edge, in radians.
    directions: Vec<f64>,
    /// Integral of the direction over the place, up to each point.
    integral: Vec<f64>,
    /// Direction gained in one round: 2π times the turning number.
    round: f64,
}

/// The length of a ring is no positive finite number in floating point.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the outline is too large or too small to be measured; scale it to an ordinary size")]
pub struct CurveLengthError;

impl BoundaryCurve {
    /// A closed boundary.
    ///
    /// # Errors
    /// [`CurveLengthError`] if its length overflows or underflows.
    ///
    /// ```
    /// use morphospace::{correspondence::Curve, geometry::{DVec2, Ring}};
    /// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    /// let curve = Curve::closed(&Ring::new(square.to_vec())?)?;
    /// assert_eq!(curve.point_at(0.625), DVec2::new(0.5, 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn closed(ring: &Ring) -> Result<Self, CurveLengthError> {
        let edges = unit_edges(ring).ok_or(CurveLengthError)?;
        let mut places = vec![0.0];
        let mut sum = 0.0;
        for edge in &edges {
            sum += edge.length();
            places.push(sum);
        }
        if !(sum.is_finite() && sum > 0.0) {
            return Err(CurveLengthError);
        }
        places.iter_mut().for_each(|place| *place /= sum);
        let directions = unwrapped(&edges);
        let mut integral = vec![0.0];
        for (e, direction) in directions.iter().enumerate() {
            integral.push(integral[e] + direction * (places[e + 1] - places[e]));
        }
        let (first, last) = (edges[0], edges[edges.len() - 1]);
        let gained = directions[edges.len() - 1] + turn(last, first) - directions[0];
        Ok(Self {
            round: TAU * (gained / TAU).round(),
            points: ring.points().to_vec(),
            places,
            directions,
            integral,
        })
    }

    /// The points in order.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The place of each point, in order; nondecreasing.
    #[must_use]
    pub fn places(&self) -> &[f64] {
        &self.places[..self.points.len()]
    }

    /// Whether the curve bends at a point of its own, by more than rounding.
    pub(super) fn bends_at(&self, point: usize) -> bool {
        let before = match point {
            0 => self.directions[self.directions.len() - 1] - self.round,
            _ => self.directions[point - 1],
        };
        (self.directions[point] - before).abs() > LEAST_BEND
    }

    /// The point at a place, exact at the curve's own points. Places
    /// are taken modulo 1.
    #[must_use]
    pub fn point_at(&self, place: f64) -> DVec2 {
        let place = self.wrapped(place);
        let e = self.edge_at(place);
        let (from, to) = (self.points[e], self.points[(e + 1) % self.points.len()]);
        let along = (place - self.places[e]) / (self.places[e + 1] - self.places[e]);
        // 0 / 0 on an edge of no length is neither: its first point stands.
        if along >= 1.0 {
            return to;
        }
        if along > 0.0 {
            from.lerp(to, along)
        } else {
            from
        }
    }

    /// How the point moves with its place: along its edge, by the curve's length.
    pub(crate) fn velocity_at(&self, place: f64) -> DVec2 {
        let e = self.edge_at(self.wrapped(place));
        let (from, to) = (self.points[e], self.points[(e + 1) % self.points.len()]);
        let span = self.places[e + 1] - self.places[e];
        // An edge of no length moves nothing.
        if span > 0.0 {
            (to - from) / span
        } else {
            DVec2::ZERO
        }
    }

    /// The place nearest to `p`, the first of several: where a pin lands.
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for e in 0..self.directions.len() {
            best = self.nearer(best, p, e, [0.0, 1.0]);
        }
        self.wrapped(best.1)
    }

    /// The place nearest to `p` among those from one to another, counted on
    /// over the seam, and how far it is. At least
    /// `from <= to`; not more than one round.
    pub(super) fn nearest_within(&self, p: DVec2, from: f64, to: f64) -> (f64, f64) {
        let to = to.min(from + 1.0);
        let mut best = (f64::INFINITY, self.wrapped(from));
        let count = self.directions.len();
        let mut base = from.floor();
        let mut e = self.edge_at(from - base);
        while base + self.places[e] <= to {
            let [start, end] = [self.places[e], self.places[e + 1]].map(|place| base + place);
            let share = |place: f64| ((place - start) / (end - start)).clamp(0.0, 1.0);
            if end > start {
                best = self.nearer(best, p, e, [share(from), share(to)]);
            }
            e += 1;
            if e == count {
                (e, base) = (0, base + 1.0);
            }
        }
        (self.wrapped(best.1), best.0.sqrt())
    }

    /// The nearest place of an edge between two shares of it, as squared
    /// distance and place, if it is nearer than `best`.
    fn nearer(&self, best: (f64, f64), p: DVec2, e: usize, [low, high]: [f64; 2]) -> (f64, f64) {
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

    /// The length, in the units of the points; may overflow for huge ones.
    pub(super) fn length(&self) -> f64 {
        perimeter(&self.points)
    }

    /// How often the tangent turns around: 1 for simple counter-clockwise
    /// boundaries, −1 for clockwise ones.
    pub(super) fn turning_number(&self) -> i32 {
        (self.round / TAU).round() as i32
    }

    /// `place` in [0, 1).
    pub(crate) fn wrapped(&self, place: f64) -> f64 {
        let place = place.rem_euclid(1.0);
        if place < 1.0 { place } else { 0.0 } // -1e-20 is rounded up to 1
    }

    /// Direction at the mean over `[from, to]`, in radians, unwrapped.
    pub(super) fn direction(&self, from: f64, to: f64) -> f64 {
        (self.direction_integral(to) - self.direction_integral(from)) / (to - from)
    }

    /// Mean direction over `reach` after the place less that before it.
    pub(super) fn turning(&self, place: f64, reach: f64) -> f64 {
        self.direction(place, place + reach) - self.direction(place - reach, place)
    }

    fn direction_integral(&self, place: f64) -> f64 {
        let rounds = place.floor();
        let rest = place - rounds;
        let whole = rounds * self.integral[self.directions.len()];
        // Round k lies k times `round` higher: so do `rest` of the last one, and
        // 0 + 1 + … of the whole ones before it.
        let gained = self.round * rounds * (rest + 0.5 * (rounds - 1.0));
        whole + gained + self.integral_within(rest)
    }

    fn integral_within(&self, place: f64) -> f64 {
        let e = self.edge_at(place);
        self.integral[e] + self.directions[e] * (place - self.places[e])
    }

    /// The last edge that starts at or before the place.
    pub(super) fn edge_at(&self, place: f64) -> usize {
        let after = self.places.partition_point(|&start| start <= place);
        after.clamp(1, self.directions.len()) - 1
    }
}

/// Edge vectors in units of the larger extent: neither overflows nor
/// underflows when squared.
fn unit_edges(ring: &Ring) -> Option<Vec<DVec2>> {
    let extent = ring.bounds().size().max_element();
    let is_measurable = extent.is_finite() && extent > 0.0;
    is_measurable.then(|| ring.edges().map(|(a, b)| (b - a) / extent).collect())
}

/// The direction of each edge, each within π of the one before.
fn unwrapped(edges: &[DVec2]) -> Vec<f64> {
    let mut direction = edges[0].to_angle();
    let mut directions = vec![direction];
    for pair in edges.windows(2) {
        direction += turn(pair[0], pair[1]);
        directions.push(direction);
    }
    directions
}

/// Exterior angle in (−π, π]; 0 where an edge is nothing.
fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}
