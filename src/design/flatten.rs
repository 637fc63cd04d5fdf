//! Flattens Bézier paths into closed polygons.
//!
//! Let a Bézier curve of degree d be divided into n arcs at equally spaced parameters. The distance
//! of each arc from its chord is at most d (d − 1) / (8 n²) times the largest second difference of
//! the control points (Wang 1984). The number of chords is therefore known in advance, and the
//! error is bounded, not estimated. The bound does not hold for curves that would need more than
//! [`MAX_PIECES`] chords: at the default tolerance, curves thousands of pages long.

use crate::geometry::DVec2;
use usvg::tiny_skia_path::{Path, PathSegment, Point};

/// Maximum number of points of a flattened design (resource limit: 32 MB).
pub(super) const MAX_POINTS: usize = 2_000_000;

/// Minimum flattening tolerance, as a fraction of the longer side of the page (tolerance: precision
/// of the `f32` coordinates in SVG drawings).
pub(super) const MIN_TOLERANCE: f64 = 1e-7;

/// Maximum number of chords per curve (resource limit: even at [`MIN_TOLERANCE`], a cubic curve
/// needs more only if the second differences of its control points exceed twice the page's longer
/// side).
const MAX_PIECES: f64 = 4096.0;

/// Error for outlines that flatten into too many points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the outlines need more than {MAX_POINTS} points; simplify their curves or raise the tolerance"
)]
pub struct TooManyPoints;

/// Flattens paths and limits the total number of points.
#[derive(Clone)]
pub(super) struct Flattener {
    tolerance: f64,
    points: usize,
}

impl Flattener {
    /// Creates a flattener. `tolerance` is the maximum distance between curves and polygons, in
    /// units of the page.
    pub(super) fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            points: 0,
        }
    }

    /// Flattens a path into closed polygons. `place` maps the path's points to the page.
    /// Open subpaths are closed, as they are when filled.
    pub(super) fn rings(
        &mut self,
        path: &Path,
        place: impl Fn(Point) -> DVec2,
    ) -> Result<Vec<Vec<DVec2>>, TooManyPoints> {
        let mut rings: Vec<Vec<DVec2>> = Vec::new();
        let mut ring: Vec<DVec2> = Vec::new();
        for segment in path.segments() {
            // A path begins with a move, so every curve has a start point.
            let last = ring.last().copied().unwrap_or_default();
            match segment {
                PathSegment::MoveTo(p) => {
                    self.points += ring.len();
                    rings.push(std::mem::replace(&mut ring, vec![place(p)]));
                }
                PathSegment::LineTo(p) => ring.push(place(p)),
                PathSegment::QuadTo(b, c) => {
                    let (b, c) = (place(b), place(c));
                    // Degree elevation: each inner control point of the equal cubic curve lies two
                    // thirds of the way from an end to the quadratic control point.
                    let elevated = |q: DVec2| q + (b - q) * (2.0 / 3.0);
                    let bend = 2.0 * (last - 2.0 * b + c).length();
                    self.curve(&mut ring, [elevated(last), elevated(c), c], bend);
                }
                PathSegment::CubicTo(b, c, d) => {
                    let [b, c, d] = [b, c, d].map(&place);
                    let bend = (last - 2.0 * b + c)
                        .length()
                        .max((b - 2.0 * c + d).length());
                    self.curve(&mut ring, [b, c, d], 6.0 * bend);
                }
                // Rings are closed implicitly, and the next subpath begins with a move.
                PathSegment::Close => {}
            }
            if self.points + ring.len() > MAX_POINTS {
                return Err(TooManyPoints);
            }
        }
        self.points += ring.len();
        rings.push(ring);
        // A ring with fewer than three points encloses no area.
        rings.retain(|ring| ring.len() >= 3);
        Ok(rings)
    }

    /// Appends a cubic curve that starts at the ring's last point. `bend` is an upper
    /// bound of the length of its second derivative.
    fn curve(&self, ring: &mut Vec<DVec2>, [b, c, d]: [DVec2; 3], bend: f64) {
        let a = ring.last().copied().unwrap_or(b);
        // Number of chords n at which Wang's bound on the error, `bend` / (8 n²), is at most the
        // tolerance.
        let pieces = (bend / (8.0 * self.tolerance)).sqrt().ceil();
        let pieces = pieces.clamp(1.0, MAX_PIECES) as u32;
        ring.extend((1..pieces).map(|k| {
            let t = f64::from(k) / f64::from(pieces);
            let s = 1.0 - t;
            s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
        }));
        // The last point is the exact end point, so that the next curve starts at identical
        // coordinates.
        ring.push(d);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use usvg::tiny_skia_path::PathBuilder;

    fn place(p: Point) -> DVec2 {
        DVec2::new(p.x.into(), p.y.into())
    }

    /// Returns the largest distance from sampled points of a quadratic curve to the polygon `ring`.
    fn error(ring: &[DVec2], [a, b, c]: [DVec2; 3]) -> f64 {
        let near = |p: DVec2| {
            ring.windows(2)
                .map(|w| {
                    let along = w[1] - w[0];
                    let s = (p - w[0]).dot(along) / along.length_squared();
                    p.distance(w[0] + s.clamp(0.0, 1.0) * along)
                })
                .fold(f64::INFINITY, f64::min)
        };
        (0..=999)
            .map(|k| f64::from(k) / 999.0)
            .map(|t| near(a.lerp(b, t).lerp(b.lerp(c, t), t)))
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_curve_stays_within_its_tolerance_and_is_not_much_finer() {
        let mut builder = PathBuilder::new();
        builder.move_to(0.0, 0.0);
        builder.quad_to(50.0, 100.0, 100.0, 0.0);
        let path = builder.finish().expect("a path");
        let curve = [DVec2::ZERO, DVec2::new(50.0, 100.0), DVec2::new(100.0, 0.0)];
        for tolerance in [1.0, 0.1, 0.01] {
            let rings = Flattener::new(tolerance)
                .rings(&path, place)
                .expect("few points");
            let error = error(&rings[0], curve);
            assert!(error <= tolerance, "{error}");
            assert!(error > 0.2 * tolerance, "{error}");
        }
    }

    #[test]
    fn open_subpaths_are_closed_and_lines_are_dropped() {
        let mut builder = PathBuilder::new();
        builder.move_to(0.0, 0.0);
        builder.line_to(1.0, 0.0);
        builder.move_to(0.0, 0.0);
        builder.line_to(1.0, 0.0);
        builder.line_to(1.0, 1.0);
        builder.close();
        builder.line_to(5.0, 5.0);
        builder.line_to(6.0, 5.0);
        let path = builder.finish().expect("a path");
        let rings = Flattener::new(1.0).rings(&path, place).expect("few points");
        assert_eq!(rings.len(), 2);
        assert_eq!(rings[0].len(), 3);
        assert_eq!(
            rings[1],
            [(0, 0), (5, 5), (6, 5)].map(|(x, y)| DVec2::new(x.into(), y.into()))
        );
    }
}
