//! Curves of a DXF drawing (lines, arcs of ellipses and NURBS) and their flattening.
//!
//! Arcs are divided evenly: a chord over the angle h deviates by at most 1 − cos(h/2) times the
//! larger semi-axis. NURBS curves (Piegl and Tiller, The NURBS Book, 1997) are evaluated by de
//! Boor's algorithm (1972). Each knot span is bisected until the curve over every interval is flat:
//! three points of the curve lie within the tolerance of the interval's chord. The error of a NURBS
//! curve is therefore estimated, not bounded.

use crate::design::flatten::MAX_POINTS;
use crate::geometry::{DVec2, FillRule, distance_squared_to_segment};
use glam::{DAffine2, DVec3};
use std::f64::consts::{PI, TAU};

/// Maximum number of chords of an arc (resource limit).
const MAX_ARC_PIECES: f64 = 4096.0;

/// Maximum depth of the recursive bisection of one half of a knot span. A span gets at most 2048
/// chords, 1024 per half (resource limit).
const MAX_BISECTIONS: u32 = 10;

/// Minimum absolute value of an arc's bulge; arcs with a smaller one count as straight (tolerance:
/// at this bulge an arc rises above its chord by 5e-8 of the chord's length).
const MIN_BULGE: f64 = 1e-7;

/// Curve of a drawing, in drawing units.
#[derive(Clone, Debug)]
pub(super) enum DxfCurve {
    Line([DVec2; 2]),
    /// Open or closed chain of straight lines.
    Chain(Vec<DVec2>),
    Arc(EllipseArc),
    Spline(NurbsCurve),
}

/// Elliptical arc: the points `centre` + cos φ · `u` + sin φ · `v` for φ from `from` to `from +
/// sweep`, in radians.
#[derive(Clone, Copy, Debug)]
pub(super) struct EllipseArc {
    pub centre: DVec2,
    pub u: DVec2,
    pub v: DVec2,
    pub from: f64,
    pub sweep: f64,
}

/// NURBS curve whose degree, knots and weights have been checked by [`Self::new`].
#[derive(Clone, Debug)]
pub(super) struct NurbsCurve {
    degree: usize,
    /// Knots in non-decreasing order.
    knots: Vec<f64>,
    /// Homogeneous control points (x w, y w, w).
    control: Vec<DVec3>,
}

impl DxfCurve {
    /// Creates the circular arc from `p` to `q` with the given DXF bulge, which is the tangent of a
    /// quarter of the arc's angle, positive for counter-clockwise arcs. Returns a line if the arc
    /// is nearly straight.
    pub fn from_bulge(p: DVec2, q: DVec2, bulge: f64) -> Self {
        let chord = q - p;
        // Signed distance from the chord to the centre, as a fraction of the chord's length.
        let to_centre = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre = p + 0.5 * chord + to_centre * chord.perp();
        let u = p - centre;
        let is_straight = bulge.abs() < MIN_BULGE || !u.is_finite();
        if is_straight || chord == DVec2::ZERO {
            return Self::Line([p, q]);
        }
        let v = u.perp();
        let sweep = 4.0 * bulge.atan();
        Self::Arc(EllipseArc {
            centre,
            u,
            v,
            from: 0.0,
            sweep,
        })
    }

    /// Returns the curve transformed by an affine map.
    pub fn transformed(&self, by: &DAffine2) -> Self {
        match self {
            Self::Line(ends) => Self::Line(ends.map(|p| by.transform_point2(p))),
            Self::Chain(points) => {
                Self::Chain(points.iter().map(|&p| by.transform_point2(p)).collect())
            }
            Self::Arc(arc) => Self::Arc(EllipseArc {
                centre: by.transform_point2(arc.centre),
                u: by.transform_vector2(arc.u),
                v: by.transform_vector2(arc.v),
                ..*arc
            }),
            Self::Spline(spline) => Self::Spline(NurbsCurve {
                degree: spline.degree,
                knots: spline.knots.clone(),
                control: spline
                    .control
                    .iter()
                    .map(|c| transformed_control(*c, by))
                    .collect(),
            }),
        }
    }

    /// Returns the number of control points; lines and arcs count as one.
    pub fn point_count(&self) -> usize {
        match self {
            Self::Chain(points) => points.len(),
            Self::Line(_) | Self::Arc(_) => 1,
            Self::Spline(spline) => spline.control.len(),
        }
    }

    /// Returns points whose bounding box contains the curve.
    pub fn hull(&self) -> Vec<DVec2> {
        match self {
            Self::Line(ends) => ends.to_vec(),
            Self::Chain(points) => points.clone(),
            Self::Arc(arc) => {
                let reach = arc.u.abs() + arc.v.abs();
                vec![arc.centre - reach, arc.centre + reach]
            }
            Self::Spline(spline) => spline
                .control
                .iter()
                .map(|&c| point_from_homogeneous(c))
                .collect(),
        }
    }

    /// Appends the points of the flattened curve, including its start. `tolerance` is the maximum
    /// deviation in drawing units.
    pub fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        match self {
            Self::Line(ends) => points.extend(ends),
            Self::Chain(chain) => points.extend(chain),
            Self::Arc(arc) => arc.flatten(tolerance, points),
            Self::Spline(spline) => spline.flatten(tolerance, points),
        }
    }
}

impl EllipseArc {
    /// Creates a circular arc; angles are in radians.
    pub fn circular(centre: DVec2, radius: f64, from: f64, sweep: f64) -> Self {
        Self {
            centre,
            u: DVec2::new(radius, 0.0),
            v: DVec2::new(0.0, radius),
            from,
            sweep,
        }
    }

    /// Returns the point at the fraction `share` of the sweep.
    fn at(&self, share: f64) -> DVec2 {
        let (sin, cos) = (self.from + share * self.sweep).sin_cos();
        self.centre + cos * self.u + sin * self.v
    }

    /// Returns whether the arc is a full ellipse.
    pub fn is_full_ellipse(&self) -> bool {
        self.sweep.abs() >= TAU - 1e-9
    }

    fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        // An upper bound of the larger semi-axis, even if u and v are not orthogonal.
        let radius = self.u.length().hypot(self.v.length());
        // Clamped for the case that the tolerance exceeds the diameter.
        let step = 2.0 * (1.0 - tolerance / radius).clamp(-1.0, 1.0).acos();
        // At least one chord per quarter turn, so that a tiny circle is still a square.
        let pieces = (self.sweep.abs() / step.min(0.5 * PI)).ceil();
        // A zero radius and sweep give NaN, which converts to 0.
        let pieces = (pieces.clamp(1.0, MAX_ARC_PIECES) as u32).max(1);
        let share = |k: u32| f64::from(k) / f64::from(pieces);
        // A full ellipse does not repeat its first point.
        let last = if self.is_full_ellipse() {
            pieces - 1
        } else {
            pieces
        };
        points.extend((0..=last).map(|k| self.at(share(k))));
    }
}

/// Applies an affine map to a homogeneous control point; the weight is unchanged.
fn transformed_control(control: DVec3, by: &DAffine2) -> DVec3 {
    let weight = control.z;
    (by.matrix2 * control.truncate() + weight * by.translation).extend(weight)
}

/// Converts a homogeneous control point to the plane.
fn point_from_homogeneous(control: DVec3) -> DVec2 {
    control.truncate() / control.z
}

impl NurbsCurve {
    /// Maximum degree (resource limit: CAD programs support up to 25).
    pub const MAX_DEGREE: usize = 25;

    /// Creates a curve. If `weights` is empty, all weights are 1. Returns `None` if the degree, the
    /// knots, and the numbers of points and weights do not fit together, or if a weight is not in
    /// [1e-9, 1e9].
    pub fn new(degree: usize, knots: Vec<f64>, points: &[DVec2], weights: &[f64]) -> Option<Self> {
        let degree_fits = (1..=Self::MAX_DEGREE).contains(&degree) && points.len() > degree;
        let knots_fit = knots.len() == points.len() + degree + 1
            && knots.is_sorted()
            && knots.get(degree) < knots.get(points.len());
        let weights_fit = weights.is_empty() || weights.len() == points.len();
        // In a larger range, rounding would lose all digits of the smaller weights.
        let is_weight = |w: &f64| (1e-9..=1e9).contains(w);
        if !(degree_fits && knots_fit && weights_fit && weights.iter().all(is_weight)) {
            return None;
        }
        let weight = |i: usize| weights.get(i).copied().unwrap_or(1.0);
        let points = points.iter().enumerate();
        let control = points.map(|(i, &p)| (p * weight(i)).extend(weight(i)));
        Some(Self {
            degree,
            knots,
            control: control.collect(),
        })
    }

    /// Evaluates the curve by de Boor's algorithm at a parameter between the knots `span` and
    /// `span + 1`.
    fn at(&self, span: usize, parameter: f64) -> DVec2 {
        let first = span - self.degree;
        // An array on the stack, because this function runs for every point of every curve.
        let mut points = [DVec3::ZERO; Self::MAX_DEGREE + 1];
        let points = &mut points[..=self.degree];
        points.copy_from_slice(&self.control[first..=span]);
        for level in 1..=self.degree {
            for j in (level..=self.degree).rev() {
                let (low, high) = (
                    self.knots[first + j],
                    self.knots[first + j + 1 + self.degree - level],
                );
                // The divisor is positive: the span has a positive length and lies between the
                // knots `low` and `high`.
                let share = (parameter - low) / (high - low);
                points[j] = points[j - 1].lerp(points[j], share);
            }
        }
        point_from_homogeneous(points[self.degree])
    }

    fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        let start = points.len();
        for span in self.degree..self.control.len() {
            if points.len() > MAX_POINTS {
                return; // the caller refuses so many points
            }
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if from < to {
                let point = |t: f64| self.at(span, t);
                if points.len() == start {
                    points.push(point(from));
                }
                // At least two chords per span, because the midpoint of an S-shaped span lies on
                // the line between the ends of the span.
                let middle = 0.5 * (from + to);
                bisect(&point, [from, middle], tolerance, MAX_BISECTIONS, points);
                bisect(&point, [middle, to], tolerance, MAX_BISECTIONS, points);
            }
        }
    }
}

/// Flattens a curve, given as a function `point` of its parameter. Appends the points after the
/// parameter `from`, up to and including `to`. Bisects the interval recursively, at most `depth`
/// levels deep.
fn bisect(
    point: &impl Fn(f64) -> DVec2,
    [from, to]: [f64; 2],
    tolerance: f64,
    depth: u32,
    points: &mut Vec<DVec2>,
) {
    let (a, b) = (point(from), point(to));
    let is_near = |share: f64| {
        let p = point(from + share * (to - from));
        distance_squared_to_segment(p, a, b).sqrt() <= tolerance
    };
    if depth == 0 || [0.25, 0.5, 0.75].into_iter().all(is_near) {
        points.push(b);
        return;
    }
    let middle = 0.5 * (from + to);
    bisect(point, [from, middle], tolerance, depth - 1, points);
    bisect(point, [middle, to], tolerance, depth - 1, points);
}

/// Closed loops of curves and the rule that decides what they enclose.
#[derive(Debug)]
pub(super) struct AreaLoops {
    pub loops: Vec<Vec<DxfCurve>>,
    pub rule: FillRule,
}

/// Returns the counter-clockwise angle from the direction `from` to the direction `to`, in (0, 2π]
/// radians.
pub(super) fn positive_angle(from: f64, to: f64) -> f64 {
    let sweep = (to - from).rem_euclid(TAU);
    // Directions that are equal up to rounding errors mean a full turn.
    if sweep <= 1e-12 { TAU } else { sweep }
}
