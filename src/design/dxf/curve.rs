//! The curves of a drawing: straight lines, arcs of ellipses and NURBS, and
//! how they become polygons.
//!
//! A chord of an arc lies within 1 − cos(h/2) times the arc's larger radius
//! for an angle of h: that many are taken. A NURBS curve (Piegl and Tiller,
//! The NURBS Book, 1997; evaluated by de Boor's algorithm, 1972) is halved in
//! each knot span until three points between two neighbours are within the
//! tolerance: its error is estimated, not bounded.

use crate::design::flatten::MAX_POINTS;
use crate::geometry::{DVec2, distance_squared_to_segment};
use glam::{DAffine2, DVec3};
use std::f64::consts::{PI, TAU};

/// Most pieces of an arc, as of any curve of a drawing, and most halvings of a
/// knot span, which give it half as many.
const MAX_ARC_PIECES: f64 = 4096.0;
const MAX_HALVINGS: u32 = 10;

/// Smallest bulge that is not straight: it rises by 5e-8 of its chord.
const MIN_BULGE: f64 = 1e-7;

/// A piece of an outline.
#[derive(Clone, Debug)]
pub(super) enum DxfCurve {
    Line([DVec2; 2]),
    Arc(EllipseArc),
    Spline(NurbsCurve),
}

/// centre + cos φ · u + sin φ · v for φ from `from` to `from + sweep`.
#[derive(Clone, Copy, Debug)]
pub(super) struct EllipseArc {
    pub centre: DVec2,
    pub u: DVec2,
    pub v: DVec2,
    pub from: f64,
    pub sweep: f64,
}

/// A NURBS curve whose numbers have been checked.
#[derive(Clone, Debug)]
pub(super) struct NurbsCurve {
    degree: usize,
    knots: Vec<f64>,
    /// x w, y w, w.
    control: Vec<DVec3>,
}

impl DxfCurve {
    /// From p to q with the tangent of a quarter of the arc's angle, counter-
    /// clockwise positive.
    pub fn bulging(p: DVec2, q: DVec2, bulge: f64) -> Self {
        let chord = q - p;
        // The bulge is tan(angle / 4): so many chords the centre lies aside.
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

    pub fn moved(&self, by: &DAffine2) -> Self {
        match self {
            Self::Line(ends) => Self::Line(ends.map(|p| by.transform_point2(p))),
            Self::Arc(arc) => Self::Arc(EllipseArc {
                centre: by.transform_point2(arc.centre),
                u: by.transform_vector2(arc.u),
                v: by.transform_vector2(arc.v),
                ..*arc
            }),
            Self::Spline(spline) => Self::Spline(NurbsCurve {
                degree: spline.degree,
                knots: spline.knots.clone(),
                control: spline.control.iter().map(|c| moved(*c, by)).collect(),
            }),
        }
    }

    /// How many points it is made from.
    pub fn size(&self) -> usize {
        match self {
            Self::Line(_) | Self::Arc(_) => 1,
            Self::Spline(spline) => spline.control.len(),
        }
    }

    /// Points between which the curve lies.
    pub fn hull(&self) -> Vec<DVec2> {
        match self {
            Self::Line(ends) => ends.to_vec(),
            Self::Arc(arc) => {
                let reach = arc.u.abs() + arc.v.abs();
                vec![arc.centre - reach, arc.centre + reach]
            }
            Self::Spline(spline) => spline.control.iter().map(|&c| projected(c)).collect(),
        }
    }

    /// Appends the curve's points, its first one too.
    pub fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        match self {
            Self::Line(ends) => points.extend(ends),
            Self::Arc(arc) => arc.flatten(tolerance, points),
            Self::Spline(spline) => spline.flatten(tolerance, points),
        }
    }
}

impl EllipseArc {
    fn at(&self, share: f64) -> DVec2 {
        let (sin, cos) = (self.from + share * self.sweep).sin_cos();
        self.centre + cos * self.u + sin * self.v
    }

    pub fn is_whole(&self) -> bool {
        self.sweep.abs() >= TAU - 1e-9
    }

    fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        // At least the larger half axis, however u and v lie to each other.
        let radius = self.u.length().hypot(self.v.length());
        // Beyond the diameter a tolerance would have no cosine.
        let step = 2.0 * (1.0 - tolerance / radius).clamp(-1.0, 1.0).acos();
        // Quarters at most, so that a small circle is still a square.
        let pieces = (self.sweep.abs() / step.min(0.5 * PI)).ceil();
        // No radius and no angle would give NaN, which is 0 as a whole number.
        let pieces = (pieces.clamp(1.0, MAX_ARC_PIECES) as u32).max(1);
        let share = |k: u32| f64::from(k) / f64::from(pieces);
        // A whole one ends where it began, and that point is there already.
        let last = if self.is_whole() { pieces - 1 } else { pieces };
        points.extend((0..=last).map(|k| self.at(share(k))));
    }
}

/// A control point sent through a map: the weight stays.
fn moved(control: DVec3, by: &DAffine2) -> DVec3 {
    let weight = control.z;
    (by.matrix2 * control.truncate() + weight * by.translation).extend(weight)
}

fn projected(control: DVec3) -> DVec2 {
    control.truncate() / control.z
}

impl NurbsCurve {
    /// Most that is read: CAD programs stop at 25.
    pub const MAX_DEGREE: usize = 25;

    /// `None` unless there are as many knots as degree and points need, in
    /// order, and all weights are positive.
    pub fn new(degree: usize, knots: Vec<f64>, points: &[DVec2], weights: &[f64]) -> Option<Self> {
        let is_known = (1..=Self::MAX_DEGREE).contains(&degree) && points.len() > degree;
        let knots_fit = knots.len() == points.len() + degree + 1
            && knots.is_sorted()
            && knots.get(degree) < knots.get(points.len());
        let weights_fit = weights.is_empty() || weights.len() == points.len();
        // Weights further apart than this lose all digits of the lighter one.
        let is_weight = |w: &f64| (1e-9..=1e9).contains(w);
        if !(is_known && knots_fit && weights_fit && weights.iter().all(is_weight)) {
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

    /// The curve at a parameter of a span: the span's first knot has the index
    /// `span`.
    fn at(&self, span: usize, parameter: f64) -> DVec2 {
        let first = span - self.degree;
        // On the stack, for this is called for every point of every curve.
        let mut points = [DVec3::ZERO; Self::MAX_DEGREE + 1];
        let points = &mut points[..=self.degree];
        points.copy_from_slice(&self.control[first..=span]);
        for level in 1..=self.degree {
            for j in (level..=self.degree).rev() {
                let (low, high) = (
                    self.knots[first + j],
                    self.knots[first + j + 1 + self.degree - level],
                );
                // The span has a length and lies between these two knots.
                let share = (parameter - low) / (high - low);
                points[j] = points[j - 1].lerp(points[j], share);
            }
        }
        projected(points[self.degree])
    }

    fn flatten(&self, tolerance: f64, points: &mut Vec<DVec2>) {
        let start = points.len();
        for span in self.degree..self.control.len() {
            if points.len() > MAX_POINTS {
                return; // the reader refuses as many
            }
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if from < to {
                let at = |t: f64| self.at(span, t);
                if points.len() == start {
                    points.push(at(from));
                }
                // Two halves at least: the middle of an S lies on its chord.
                let middle = 0.5 * (from + to);
                halve(&at, [from, middle], tolerance, MAX_HALVINGS, points);
                halve(&at, [middle, to], tolerance, MAX_HALVINGS, points);
            }
        }
    }
}

/// Appends the points after `from` up to `to`.
fn halve(
    at: &impl Fn(f64) -> DVec2,
    [from, to]: [f64; 2],
    tolerance: f64,
    halvings: u32,
    points: &mut Vec<DVec2>,
) {
    let (a, b) = (at(from), at(to));
    let is_near = |share: f64| {
        let p = at(from + share * (to - from));
        distance_squared_to_segment(p, a, b).sqrt() <= tolerance
    };
    if halvings == 0 || [0.25, 0.5, 0.75].into_iter().all(is_near) {
        points.push(b);
        return;
    }
    let middle = 0.5 * (from + to);
    halve(at, [from, middle], tolerance, halvings - 1, points);
    halve(at, [middle, to], tolerance, halvings - 1, points);
}
