//! Polylines with a width, and strokes along lines.
//!
//! A band of constant width and a stroke are outlined by `tiny-skia`; a band whose width changes
//! consists of one trapezium for each chord, which meet in mitres. `tiny-skia` computes in `f32`,
//! so the points are first moved to the origin and scaled.

use super::curve::DxfCurve;
use crate::design::flatten::{Flattener, TooManyPoints};
use crate::design::svg::WindingRings;
use crate::geometry::{Bounds, DVec2};
use glam::DAffine2;
use usvg::tiny_skia_path::{LineCap, LineJoin, PathBuilder, Point, Stroke};

/// Polyline with a width, in its own coordinate system.
#[derive(Clone, Debug)]
pub(super) struct WideBand {
    /// Lines and arcs between neighbouring vertices.
    pub curves: Vec<DxfCurve>,
    /// Widths at the start and the end of each curve.
    pub widths: Vec<[f64; 2]>,
    pub is_closed: bool,
    /// Affine map to the drawing.
    pub place: DAffine2,
}

impl WideBand {
    /// Returns points of the drawing whose bounding box contains the band.
    pub fn hull(&self) -> Vec<DVec2> {
        let reach = 0.5
            * self
                .widths
                .iter()
                .flatten()
                .fold(0.0, |a: f64, &b| a.max(b));
        let hull = self.curves.iter().flat_map(DxfCurve::hull);
        let corners = Bounds::of(hull).map(|bounds| bounds.padded(reach).corners());
        let place = |p: DVec2| self.place.transform_point2(p);
        corners.into_iter().flatten().map(place).collect()
    }

    /// Returns the area of the band in the drawing. `tolerance` is the maximum deviation in drawing
    /// units.
    pub fn area(
        &self,
        tolerance: f64,
        flattener: &mut Flattener,
    ) -> Result<WindingRings, TooManyPoints> {
        let scale = self
            .place
            .matrix2
            .x_axis
            .length()
            .max(self.place.matrix2.y_axis.length());
        let own_tolerance = tolerance / scale.max(f64::MIN_POSITIVE);
        let first = self.widths[0][0];
        let is_constant = self.widths.iter().flatten().all(|&width| width == first);
        let rings = match is_constant {
            true => {
                let mut points = Vec::new();
                for curve in &self.curves {
                    curve.flatten(own_tolerance, &mut points);
                }
                let pen = Pen {
                    width: first,
                    is_round: false,
                    tolerance: own_tolerance,
                };
                pen.stroke(&points, self.is_closed, flattener)?
            }
            false => self.trapezia(own_tolerance),
        };
        let place = |p: DVec2| self.place.transform_point2(p);
        Ok(rings
            .into_iter()
            .map(|ring| ring.into_iter().map(place).collect())
            .collect())
    }

    /// Returns one trapezium for each chord, and a triangle for each corner that is too sharp for
    /// the trapezia to meet. All run counter-clockwise, so that they unite under the non-zero rule.
    fn trapezia(&self, tolerance: f64) -> WindingRings {
        let chords = self.chords(tolerance);
        let mut rings = Vec::with_capacity(chords.len());
        for (k, chord) in chords.iter().enumerate() {
            let [before, after] = [k.checked_sub(1), Some(k + 1)].map(|k| chords.get(k?));
            let (first, last) = match self.is_closed {
                true => (before.or(chords.last()), after.or(chords.first())),
                false => (before, after),
            };
            let [from, to] = chord.ends;
            let start = chord.half_widths[0] * first.map_or(chord.side, |first| chord.mitre(first));
            let end = chord.half_widths[1] * last.map_or(chord.side, |last| chord.mitre(last));
            rings.push(vec![from - start, to - end, to + end, from + start]);
            rings.extend(last.and_then(|last| chord.wedge(last)));
        }
        rings
    }

    /// Returns the chords of the flattened band.
    fn chords(&self, tolerance: f64) -> Vec<BandChord> {
        let mut chords = Vec::new();
        for (curve, &[from, to]) in self.curves.iter().zip(&self.widths) {
            let mut points = Vec::new();
            curve.flatten(tolerance, &mut points);
            points.dedup();
            let count = points.len().saturating_sub(1).max(1) as f64;
            let half_width = |k: usize| 0.5 * (from + (to - from) * (k as f64 / count));
            let chord = |(k, ends): (usize, &[DVec2])| BandChord {
                ends: [ends[0], ends[1]],
                half_widths: [half_width(k), half_width(k + 1)],
                side: (ends[1] - ends[0]).normalize_or_zero().perp(),
            };
            chords.extend(points.windows(2).enumerate().map(chord));
        }
        chords
    }
}

/// Straight piece of a band.
struct BandChord {
    ends: [DVec2; 2],
    /// Half of the width at each end.
    half_widths: [f64; 2],
    /// Unit vector to the left.
    side: DVec2,
}

/// Cosine of the largest turn at which two chords meet in a mitre (DXF programs cut corners off
/// beyond a turn of 150°; here beyond 90°, from where a mitre is longer than the band is wide).
const MITRE_COSINE: f64 = 0.0;

impl BandChord {
    /// Returns the direction, scaled by the length of a mitre, in which the outline lies at the end
    /// that this chord shares with another one.
    fn mitre(&self, other: &Self) -> DVec2 {
        let cosine = self.side.dot(other.side);
        match cosine > MITRE_COSINE {
            true => (self.side + other.side) / (1.0 + cosine),
            false => self.side,
        }
    }

    /// Returns the triangle that fills the outer side of the corner between this chord and the
    /// next one; `None` if they meet in a mitre.
    fn wedge(&self, next: &Self) -> Option<Vec<DVec2>> {
        if self.side.dot(next.side) > MITRE_COSINE {
            return None;
        }
        let corner = self.ends[1];
        let half_width = self.half_widths[1].min(next.half_widths[0]);
        let [a, b] = [half_width * self.side, half_width * next.side];
        // In a left turn, the outer side is the right one.
        Some(match self.side.perp_dot(next.side) > 0.0 {
            true => vec![corner, corner - a, corner - b],
            false => vec![corner, corner + b, corner + a],
        })
    }
}

/// Pen that draws strokes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    pub width: f64,
    /// Whether ends and corners are round; otherwise ends are cut off and corners are pointed.
    pub is_round: bool,
    /// Maximum deviation of the outline.
    pub tolerance: f64,
}

/// Side length of the square into which points are scaled for `tiny-skia` (tolerance: of the order
/// of a page in pixels, for which its internal tolerances are made).
const STROKER_SIZE: f64 = 1000.0;

/// Maximum resolution of the stroker (resource limit, as in SVG drawings).
const MAX_RESOLUTION: f64 = 1e6;

impl Pen {
    /// Returns the area of a stroke along `points`, filled by the non-zero rule.
    pub fn stroke(
        &self,
        points: &[DVec2],
        is_closed: bool,
        flattener: &mut Flattener,
    ) -> Result<WindingRings, TooManyPoints> {
        let Some(bounds) = Bounds::of(points.iter().copied()) else {
            return Ok(Vec::new());
        };
        let size = bounds.size().max_element() + self.width;
        let (centre, scale) = (bounds.centre(), STROKER_SIZE / size);
        let mut path = PathBuilder::new();
        for (k, &p) in points.iter().enumerate() {
            let DVec2 { x, y } = (p - centre) * scale;
            match k {
                0 => path.move_to(x as f32, y as f32),
                _ => path.line_to(x as f32, y as f32),
            }
        }
        if is_closed {
            path.close();
        }
        let stroke = Stroke {
            width: (self.width * scale) as f32,
            line_cap: if self.is_round {
                LineCap::Round
            } else {
                LineCap::Butt
            },
            line_join: if self.is_round {
                LineJoin::Round
            } else {
                LineJoin::Miter
            },
            ..Stroke::default()
        };
        // The stroker's error is a quarter of a unit divided by the resolution.
        let resolution = (0.25 / (self.tolerance * scale)).clamp(1.0, MAX_RESOLUTION) as f32;
        let outline = path
            .finish()
            .and_then(|path| path.stroke(&stroke, resolution));
        let place = |p: Point| centre + DVec2::new(p.x.into(), p.y.into()) / scale;
        outline.map_or(Ok(Vec::new()), |outline| flattener.rings(&outline, place))
    }
}
