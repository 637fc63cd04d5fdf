//! Paths over a map: smooth curves through waypoints, some of which are stops.

use crate::geometry::{DVec2, nearest_segment_parameter};
use serde::{Deserialize, Serialize};

/// A place on a map through which a path leads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Waypoint {
    /// Position on the map.
    pub at: DVec2,
    /// Whether the path passes through this place without a stop. The first and the last place are
    /// always stops, regardless of this flag.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub passed: bool,
    /// Name of the blend at this place; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
}

impl Waypoint {
    /// Creates a stop without a name.
    #[must_use]
    pub fn stop(at: DVec2) -> Self {
        Self {
            at,
            passed: false,
            name: String::new(),
        }
    }

    /// Creates a place that the path passes without a stop.
    #[must_use]
    pub fn via(at: DVec2) -> Self {
        Self {
            passed: true,
            ..Self::stop(at)
        }
    }
}

/// Sequence of waypoints on a map. It forms a path only if there are at least two.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MapPath {
    /// Name of the path; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Waypoints in order.
    pub places: Vec<Waypoint>,
}

impl MapPath {
    /// Returns whether there are fewer than two waypoints, so that there is no path.
    #[must_use]
    pub fn is_too_short(&self) -> bool {
        self.places.len() < 2
    }

    /// Returns the stops with their indices in `places`: at least two, or none if there is no path.
    pub fn stops(&self) -> impl Iterator<Item = (usize, &Waypoint)> {
        let last = self.places.len().saturating_sub(1);
        let places = self.places.iter().enumerate().filter(move |_| last > 0);
        places.filter(move |(k, place)| *k == 0 || *k == last || !place.passed)
    }

    /// Returns the number of segments between consecutive stops; 0 if there is no path.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        self.stops().count().saturating_sub(1)
    }
}

/// The smooth curve of a path, parametrised by arc length within each segment.
#[derive(Clone, Debug)]
pub struct MapCurve {
    spans: Vec<CurveSpan>,
    /// For each segment, the index of its first cubic curve in `spans` and the index after its last
    /// one.
    segments: Vec<[usize; 2]>,
}

/// Cubic curve from one waypoint to the next.
#[derive(Clone, Debug)]
struct CurveSpan {
    /// Coefficients of 1, u, u² and u³ in the polynomial that gives the position at u, for u from 0
    /// to 1.
    cubic: [DVec2; 4],
    /// Exact position at u = 1. If it were computed from `cubic`, a rounding error could make the
    /// curve miss the site of a design.
    end: DVec2,
    /// Arc length from u = 0 to each of the evenly spaced u = k / [`STEPS`].
    lengths: [f64; STEPS + 1],
}

/// Number of chords that approximate the arc length of a cubic curve (tolerance: with more chords,
/// no position would change by a pixel).
const STEPS: usize = 32;

impl CurveSpan {
    fn new(cubic: [DVec2; 4], end: DVec2) -> Self {
        let mut span = Self {
            cubic,
            end,
            lengths: [0.0; STEPS + 1],
        };
        for k in 1..=STEPS {
            let [a, b] = [k - 1, k].map(|k| span.point(k as f64 / STEPS as f64));
            span.lengths[k] = span.lengths[k - 1] + a.distance(b);
        }
        span
    }

    /// Returns the position at parameter `u` in [0, 1]; exact at 1.
    fn point(&self, u: f64) -> DVec2 {
        if u == 1.0 {
            return self.end;
        }
        let [a, b, c, d] = self.cubic;
        a + (b + (c + d * u) * u) * u
    }

    fn length(&self) -> f64 {
        self.lengths[STEPS]
    }

    /// Returns the position at the given arc length from the start of this cubic curve.
    fn at(&self, length: f64) -> DVec2 {
        let k = self.lengths.partition_point(|&to| to < length);
        let k = k.clamp(1, STEPS);
        let [from, to] = [self.lengths[k - 1], self.lengths[k]];
        let fraction = if to > from {
            ((length - from) / (to - from)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.point((k as f64 - 1.0 + fraction) / STEPS as f64)
    }
}

impl MapCurve {
    /// Creates the curve of a path; returns `None` if there are fewer than two waypoints.
    ///
    /// The curve is a centripetal Catmull-Rom spline, which makes no loops between waypoints,
    /// however close they are (Yuksel, Schaefer and Keyser, "On the parameterization of
    /// Catmull-Rom curves", 2009). A path that ends where it starts is smooth there too.
    #[must_use]
    pub fn new(path: &MapPath) -> Option<Self> {
        let stops: Vec<usize> = path.stops().map(|(k, _)| k).collect();
        let segments: Vec<[usize; 2]> = stops.windows(2).map(|two| [two[0], two[1]]).collect();
        if segments.is_empty() {
            return None;
        }
        let places: Vec<DVec2> = path.places.iter().map(|place| place.at).collect();
        let spans = (1..places.len()).map(|k| CurveSpan::new(cubic(&places, k), places[k]));
        Some(Self {
            spans: spans.collect(),
            segments,
        })
    }

    /// Returns the number of segments between consecutive stops, at least one.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        self.segments.len()
    }

    /// Returns the length of a segment, in map units.
    #[must_use]
    pub fn length(&self, segment: usize) -> f64 {
        self.spans_of(segment).iter().map(CurveSpan::length).sum()
    }

    /// Returns the position at a fraction of a segment's length. Below 0 and above 1, the curve
    /// continues straight.
    #[must_use]
    pub fn place(&self, segment: usize, fraction: f64) -> DVec2 {
        let spans = self.spans_of(segment);
        let (first, last) = (&spans[0], &spans[spans.len() - 1]);
        let length = self.length(segment);
        if fraction <= 0.0 {
            let direction = first.point(1.0 / STEPS as f64) - first.cubic[0];
            return first.cubic[0] + direction.normalize_or_zero() * (fraction * length);
        }
        if fraction >= 1.0 {
            let direction = last.end - last.point(1.0 - 1.0 / STEPS as f64);
            return last.end + direction.normalize_or_zero() * ((fraction - 1.0) * length);
        }
        let mut remaining = fraction * length;
        for span in spans {
            if remaining <= span.length() {
                return span.at(remaining);
            }
            remaining -= span.length();
        }
        last.end
    }

    /// Returns the position at `t`. Stops are counted from 0: the stop with number k is at t = k.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec2 {
        let (segment, fraction) = crate::transition::segment_at(self.segments.len(), t);
        self.place(segment, fraction)
    }

    fn spans_of(&self, segment: usize) -> &[CurveSpan] {
        let [from, to] = self.segments[segment];
        &self.spans[from..to]
    }
}

/// Simplifies a polyline (Douglas and Peucker 1973). Its two ends do not change.
///
/// Every removed point lies within `tolerance` of the simplified line.
#[must_use]
pub fn simplify_polyline(line: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return Vec::new();
    };
    let distance =
        |p: &DVec2| p.distance(first.lerp(last, nearest_segment_parameter(*p, first, last)));
    let inner = line.iter().enumerate().take(line.len() - 1).skip(1);
    let farthest = inner.max_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    match farthest {
        Some((k, p)) if distance(p) > tolerance => {
            let mut simplified = simplify_polyline(&line[..=k], tolerance);
            simplified.pop();
            simplified.extend(simplify_polyline(&line[k..], tolerance));
            simplified
        }
        _ => vec![first, last],
    }
}

/// Returns the cubic curve from waypoint k − 1 to waypoint k: the coefficients of 1, u, u² and u³
/// in the polynomial that gives the position at u, for u in [0, 1].
fn cubic(places: &[DVec2], k: usize) -> [DVec2; 4] {
    let last = places.len() - 1;
    let is_closed = last > 1 && places[0] == places[last];
    let [from, to] = [places[k - 1], places[k]];
    let before = match k {
        1 if is_closed => places[last - 1],
        1 => from,
        _ => places[k - 2],
    };
    let after = match k {
        _ if k == last && is_closed => places[1],
        _ if k == last => to,
        _ => places[k + 1],
    };
    // Centripetal parametrisation: knot intervals are square roots of distances.
    let gap = |a: DVec2, b: DVec2| a.distance(b).sqrt();
    let (interval_before, interval, interval_after) =
        (gap(before, from), gap(from, to), gap(to, after));
    let chord = to - from;
    let tangent = |other: DVec2, gap: f64| match interval > 0.0 && gap > 0.0 {
        // Mean of the slopes of this curve and the neighbouring one, weighted towards the one with
        // the shorter knot interval. The slope is scaled to the parameter of this curve, which runs
        // from 0 to 1.
        true => (chord * gap / interval + other * interval / gap) * (interval / (interval + gap)),
        false => chord,
    };
    let (start, end) = (
        tangent(from - before, interval_before),
        tangent(after - to, interval_after),
    );
    let [square, cube] = [chord * 3.0 - start * 2.0 - end, start + end - chord * 2.0];
    [from, start, square, cube]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(places: &[(f64, f64, bool)]) -> MapPath {
        let place = |&(x, y, passed): &(f64, f64, bool)| Waypoint {
            passed,
            ..Waypoint::stop(DVec2::new(x, y))
        };
        MapPath {
            name: String::new(),
            places: places.iter().map(place).collect(),
        }
    }

    #[test]
    fn the_curve_meets_its_stops_at_whole_t() {
        let path = path(&[
            (0.0, 0.0, true),
            (0.5, 0.4, true),
            (1.0, 0.0, false),
            (0.3, -0.7, true),
        ]);
        assert_eq!(path.segment_count(), 2);
        let curve = MapCurve::new(&path).expect("a path");
        assert_eq!(curve.segment_count(), 2);
        for (t, k) in [(0.0, 0), (1.0, 2), (2.0, 3)] {
            assert_eq!(curve.at(t), path.places[k].at);
        }
        assert!(MapCurve::new(&MapPath::default()).is_none());
    }

    #[test]
    fn the_curve_has_constant_speed_and_smooth_direction() {
        let path = path(&[
            (0.0, 0.0, false),
            (0.1, 0.5, true),
            (0.9, 0.6, false),
            (1.0, 0.0, false),
        ]);
        let curve = MapCurve::new(&path).expect("a path");
        let places: Vec<DVec2> = (0..=400).map(|k| curve.at(f64::from(k) / 200.0)).collect();
        let steps: Vec<DVec2> = places.windows(2).map(|two| two[1] - two[0]).collect();
        for segment in [&steps[..200], &steps[200..]] {
            let mean = segment.iter().map(|step| step.length()).sum::<f64>() / 200.0;
            let deviation = |step: &DVec2| (step.length() / mean - 1.0).abs();
            assert!(segment.iter().map(deviation).fold(0.0, f64::max) < 0.02);
        }
        let turns = steps.windows(2).map(|two| two[0].angle_to(two[1]).abs());
        assert!(turns.fold(0.0, f64::max) < 0.1);
        // The curve continues straight beyond its ends.
        let [before, first] = [curve.at(-0.1), curve.at(0.0)];
        assert!((first - before).angle_to(steps[0]).abs() < 0.05);
    }

    #[test]
    fn a_closed_path_is_smooth_at_its_start() {
        let path = path(&[
            (0.0, 0.0, false),
            (1.0, 0.0, false),
            (0.5, 1.0, false),
            (0.0, 0.0, false),
        ]);
        let curve = MapCurve::new(&path).expect("a path");
        let [out, back] = [
            curve.at(0.001) - curve.at(0.0),
            curve.at(3.0) - curve.at(2.999),
        ];
        assert!(out.angle_to(back).abs() < 0.02);
    }

    #[test]
    fn coincident_places_give_finite_positions() {
        let path = path(&[(0.2, 0.1, false), (0.2, 0.1, false), (0.4, 0.1, false)]);
        let curve = MapCurve::new(&path).expect("a path");
        for t in [-0.5, 0.0, 0.5, 1.0, 1.5, 2.0] {
            assert!(curve.at(t).is_finite(), "{t}");
        }
        assert_eq!(curve.length(0), 0.0);
    }
}
