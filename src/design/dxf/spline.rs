//! Splines: NURBS given by control points, and cubic splines through fit points.
//!
//! A spline through fit points is the twice continuously differentiable cubic spline whose
//! parameter is the chord length (de Boor, A Practical Guide to Splines, 1978, chapter IV). An end
//! with a tangent has that direction at unit speed; an end without one has no curvature. A closed
//! spline is periodic. CAD programs draw fit points in this way.

use super::curve::NurbsCurve;
use super::error::EntityFault;
use super::record::DxfRecord;
use crate::geometry::DVec2;

/// Flag of a closed spline (group code 70).
const CLOSED: i64 = 1;

/// Reads the curve of a SPLINE entity.
pub(super) fn spline(record: &DxfRecord) -> Result<NurbsCurve, EntityFault> {
    let control = record.points(10)?;
    if control.is_empty() {
        let tangent = |code: i32| -> Result<Option<DVec2>, EntityFault> {
            let tangent = record.optional_point(code)?;
            Ok(tangent.map(|tangent| tangent.truncate()))
        };
        let tangents = [tangent(12)?, tangent(13)?];
        let is_closed = record.integer(70)? & CLOSED != 0;
        return through_fit_points(&record.points(11)?, tangents, is_closed);
    }
    let degree = usize::try_from(record.integer(71)?).unwrap_or(0);
    with_control_points(degree, record.reals(40)?, &control, &record.reals(41)?)
}

/// Creates the curve with the given control points.
pub(super) fn with_control_points(
    degree: usize,
    knots: Vec<f64>,
    control: &[DVec2],
    weights: &[f64],
) -> Result<NurbsCurve, EntityFault> {
    if knots.is_empty() {
        return Err("it has no knots".into());
    }
    NurbsCurve::new(degree, knots, control, weights)
        .ok_or_else(|| "its degree, knots, control points and weights are inconsistent".into())
}

/// Creates the cubic spline through fit points. `tangents` are the directions at the start and at
/// the end, if given.
pub(super) fn through_fit_points(
    points: &[DVec2],
    tangents: [Option<DVec2>; 2],
    is_closed: bool,
) -> Result<NurbsCurve, EntityFault> {
    let mut points = points.to_vec();
    points.dedup();
    if is_closed && points.first() != points.last() {
        points.extend(points.first().copied());
    }
    if points.len() < 2 {
        return Err("it has neither control points nor two different fit points".into());
    }
    let spans: Vec<f64> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
    if !spans.iter().all(|span| span.is_normal()) {
        return Err("two of its fit points are too close together".into());
    }
    let slopes = match is_closed && points.len() > 3 {
        true => periodic_slopes(&points, &spans),
        false => end_slopes(&points, &spans, tangents),
    };
    Ok(bezier_spans(&points, &spans, &slopes).ok_or("its fit points cannot be joined")?)
}

/// Converts a spline to a NURBS curve with three equal knots between neighbouring spans. `slopes`
/// are the derivatives at the points.
fn bezier_spans(points: &[DVec2], spans: &[f64], slopes: &[DVec2]) -> Option<NurbsCurve> {
    let mut control = vec![points[0]];
    let mut knots = vec![0.0; 4];
    let mut at = 0.0;
    for (i, &span) in spans.iter().enumerate() {
        let handle = span / 3.0;
        control.push(points[i] + handle * slopes[i]);
        control.push(points[i + 1] - handle * slopes[i + 1]);
        control.push(points[i + 1]);
        at += span;
        knots.extend([at; 3]);
    }
    knots.push(at);
    NurbsCurve::new(3, knots, &control, &[])
}

/// Symmetric tridiagonal system for the derivatives of a spline: continuity of the second
/// derivative at each point.
struct SlopeSystem {
    diagonal: Vec<f64>,
    /// Coupling of each point with the next one.
    coupling: Vec<f64>,
    right: Vec<DVec2>,
}

impl SlopeSystem {
    /// Creates the system whose ends have no curvature.
    fn of(points: &[DVec2], spans: &[f64]) -> Self {
        let mut system = Self {
            diagonal: vec![0.0; points.len()],
            coupling: Vec::with_capacity(spans.len()),
            right: vec![DVec2::ZERO; points.len()],
        };
        for (i, &span) in spans.iter().enumerate() {
            let pull = 3.0 * (points[i + 1] - points[i]) / (span * span);
            for end in [i, i + 1] {
                system.diagonal[end] += 2.0 / span;
                system.right[end] += pull;
            }
            system.coupling.push(1.0 / span);
        }
        system
    }

    /// Prescribes the value of an end, the first or last unknown.
    fn fix(&mut self, end: usize, value: DVec2) {
        let last = self.diagonal.len() - 1;
        let (neighbour, coupling) = if end == 0 {
            (1, 0)
        } else {
            (last - 1, last - 1)
        };
        self.right[neighbour] -= self.coupling[coupling] * value;
        self.coupling[coupling] = 0.0;
        self.diagonal[end] = 1.0;
        self.right[end] = value;
    }

    /// Solves the system for the right-hand side `right` by elimination.
    fn solve(&self, right: &[DVec2]) -> Vec<DVec2> {
        let mut diagonal = self.diagonal.clone();
        let mut solution = right.to_vec();
        for i in 1..diagonal.len() {
            let factor = self.coupling[i - 1] / diagonal[i - 1];
            diagonal[i] -= factor * self.coupling[i - 1];
            let before = solution[i - 1];
            solution[i] -= factor * before;
        }
        for i in (0..diagonal.len()).rev() {
            if let Some(&after) = solution.get(i + 1) {
                solution[i] -= self.coupling[i] * after;
            }
            solution[i] /= diagonal[i];
        }
        solution
    }
}

/// Returns the derivatives of an open spline.
fn end_slopes(points: &[DVec2], spans: &[f64], tangents: [Option<DVec2>; 2]) -> Vec<DVec2> {
    let mut system = SlopeSystem::of(points, spans);
    for (end, tangent) in [0, points.len() - 1].into_iter().zip(tangents) {
        if let Some(direction) = tangent.and_then(DVec2::try_normalize) {
            system.fix(end, direction);
        }
    }
    system.solve(&system.right)
}

/// Returns the derivatives of a periodic spline, whose last point is its first (Sherman and
/// Morrison 1950: the coupling of the last with the first point is a correction of rank one).
fn periodic_slopes(points: &[DVec2], spans: &[f64]) -> Vec<DVec2> {
    let mut system = SlopeSystem::of(points, spans);
    // The last point is not an unknown of its own; its equation adds to that of the first point.
    let last = points.len() - 1;
    let (closing, pull) = (spans[last - 1], system.right[last]);
    system.diagonal[0] += 2.0 / closing;
    system.right[0] += pull;
    system.diagonal.truncate(last);
    system.right.truncate(last);
    system.coupling.truncate(last - 1);
    let corner = 1.0 / closing;
    // The matrix is T + c (e₁ + eₙ)(e₁ + eₙ)ᵀ with the tridiagonal matrix T.
    system.diagonal[0] -= corner;
    system.diagonal[last - 1] -= corner;
    let mut ends = vec![DVec2::ZERO; last];
    ends[0] = DVec2::ONE;
    ends[last - 1] = DVec2::ONE;
    let (mut slopes, correction) = (system.solve(&system.right), system.solve(&ends));
    let sum = |values: &[DVec2]| values[0] + values[last - 1];
    let factor = corner * sum(&slopes) / (1.0 + corner * sum(&correction));
    for (slope, correction) in slopes.iter_mut().zip(&correction) {
        *slope -= factor * *correction;
    }
    slopes.push(slopes[0]);
    slopes
}

#[cfg(test)]
mod tests {
    use super::super::curve::DxfCurve;
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn flat(curve: NurbsCurve) -> Vec<DVec2> {
        let mut points = Vec::new();
        DxfCurve::Spline(curve).flatten(1e-5, &mut points);
        points
    }

    #[test]
    fn a_closed_spline_through_points_of_a_circle_is_smooth_and_nearly_round() {
        let points: Vec<DVec2> = (0..8)
            .map(|k| DVec2::from_angle(TAU * f64::from(k) / 8.0))
            .collect();
        let ring = flat(through_fit_points(&points, [None; 2], true).expect("a spline"));
        for p in &ring {
            assert!((p.length() - 1.0).abs() < 2e-3, "{p}");
        }
        // By symmetry, the curve is perpendicular to the radius at each fit point.
        let start = (ring[1] - ring[0]).normalize();
        assert!(start.dot(ring[0]).abs() < 1e-2, "{start}");
    }

    #[test]
    fn a_spline_with_tangents_reproduces_a_cubic() {
        // With two points and unit tangents along a line, the spline is that line.
        let points = [DVec2::ZERO, DVec2::new(3.0, 4.0)];
        let along = Some(DVec2::new(30.0, 40.0));
        let line = flat(through_fit_points(&points, [along, along], false).expect("a spline"));
        assert!(line.iter().all(|p| (4.0 * p.x - 3.0 * p.y).abs() < 1e-9));
        // Perpendicular tangents give an S or a C of known height: the middle of a Hermite cubic
        // is the middle of the chord plus an eighth of the difference of the end derivatives.
        let up = [Some(DVec2::Y), Some(-DVec2::Y)];
        let arch = [DVec2::ZERO, DVec2::new(8.0, 0.0)];
        let arch = flat(through_fit_points(&arch, up, false).expect("a spline"));
        let top = arch.iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((top - 2.0).abs() < 1e-3, "{top}");
    }

    #[test]
    fn natural_ends_have_no_curvature() {
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 1.0)].map(DVec2::from);
        let curve = flat(through_fit_points(&points, [None; 2], false).expect("a spline"));
        let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).angle_to(c - b).abs() / (c - a).length();
        let start = turn(curve[0], curve[1], curve[2]);
        let middle = (1..curve.len() - 1).map(|i| turn(curve[i - 1], curve[i], curve[i + 1]));
        let middle = middle.fold(0.0, f64::max);
        assert!(start < 0.2 * middle, "{start} of {middle}");
        assert!(middle < PI);
    }

    #[test]
    fn degenerate_fit_points_are_refused() {
        let twice = [DVec2::ONE, DVec2::ONE];
        for points in [&[][..], &twice] {
            assert!(through_fit_points(points, [None; 2], false).is_err());
        }
        assert!(with_control_points(3, Vec::new(), &[DVec2::ZERO; 4], &[]).is_err());
    }
}
