//! A path over a map: smooth, through places, some of which are stops.

use crate::geometry::{DVec2, nearest_segment_parameter};
use serde::{Deserialize, Serialize};

/// A place that a path goes through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Waypoint {
    /// Where on the map.
    pub at: DVec2,
    /// It is passed by, and no stop; the first and the last place always are stops.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub passed: bool,
    /// What the blend there is called; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
}

impl Waypoint {
    /// A stop without a name.
    #[must_use]
    pub fn stop(at: DVec2) -> Self {
        Self {
            at,
            passed: false,
            name: String::new(),
        }
    }

    /// A place on the way.
    #[must_use]
    pub fn passed(at: DVec2) -> Self {
        Self {
            passed: true,
            ..Self::stop(at)
        }
    }
}

/// Places in their order; a path where there are two or more.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MapPath {
    /// What it is called; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What it goes through.
    pub places: Vec<Waypoint>,
}

impl MapPath {
    /// Whether there is nothing to go along.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.places.len() < 2
    }

    /// The stops with their numbers among the places: two or more, or none.
    pub fn stops(&self) -> impl Iterator<Item = (usize, &Waypoint)> {
        let last = self.places.len().saturating_sub(1);
        let all = self.places.iter().enumerate().filter(move |_| last > 0);
        all.filter(move |(k, place)| *k == 0 || *k == last || !place.passed)
    }

    /// How many ways from stop to stop there are.
    #[must_use]
    pub fn leg_count(&self) -> usize {
        self.stops().count().saturating_sub(1)
    }
}

/// The curve of a path, by its length.
#[derive(Clone, Debug)]
pub struct MapCurve {
    spans: Vec<CurveSpan>,
    /// For each leg the numbers of its first span and of that behind its last.
    legs: Vec<[usize; 2]>,
}

/// From one place to the next.
#[derive(Clone, Debug)]
struct CurveSpan {
    /// Coefficients of 1, u, u² and u³, u in [0, 1].
    cubic: [DVec2; 4],
    /// The place at u = 1, to the last bit: it may be a design's site.
    end: DVec2,
    /// The lengths up to evenly spaced u.
    lengths: [f64; STEPS + 1],
}

/// Pieces of a span whose lengths are added: with more, nothing moves by a pixel.
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

    /// Where so much of its length lies behind.
    fn at(&self, length: f64) -> DVec2 {
        let k = self.lengths.partition_point(|&to| to < length);
        let k = k.clamp(1, STEPS);
        let [from, to] = [self.lengths[k - 1], self.lengths[k]];
        let share = if to > from {
            ((length - from) / (to - from)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.point((k as f64 - 1.0 + share) / STEPS as f64)
    }
}

impl MapCurve {
    /// The smooth curve through the places of a path: centripetal Catmull-Rom splines,
    /// which make no loops between places however near to each other these are (Yuksel,
    /// Schaefer, Keyser, "On the parameterization of Catmull-Rom curves", 2009). A path
    /// that ends where it begins is smooth there as well. None where there is no path.
    #[must_use]
    pub fn new(path: &MapPath) -> Option<Self> {
        let stops: Vec<usize> = path.stops().map(|(k, _)| k).collect();
        let legs: Vec<[usize; 2]> = stops.windows(2).map(|two| [two[0], two[1]]).collect();
        if legs.is_empty() {
            return None;
        }
        let places: Vec<DVec2> = path.places.iter().map(|place| place.at).collect();
        let spans = (1..places.len()).map(|k| CurveSpan::new(cubic(&places, k), places[k]));
        Some(Self {
            spans: spans.collect(),
            legs,
        })
    }

    /// How many ways from stop to stop there are, at least one.
    #[must_use]
    pub fn leg_count(&self) -> usize {
        self.legs.len()
    }

    /// How long a leg is.
    #[must_use]
    pub fn length(&self, leg: usize) -> f64 {
        self.of(leg).iter().map(CurveSpan::length).sum()
    }

    /// The place at a share of a leg's length; beyond its ends straight on.
    #[must_use]
    pub fn place(&self, leg: usize, share: f64) -> DVec2 {
        let spans = self.of(leg);
        let (first, last) = (&spans[0], &spans[spans.len() - 1]);
        let whole = self.length(leg);
        if share <= 0.0 {
            let onward = first.point(1.0 / STEPS as f64) - first.cubic[0];
            return first.cubic[0] + onward.normalize_or_zero() * (share * whole);
        }
        if share >= 1.0 {
            let onward = last.end - last.point(1.0 - 1.0 / STEPS as f64);
            return last.end + onward.normalize_or_zero() * ((share - 1.0) * whole);
        }
        let mut left = share * whole;
        for span in spans {
            if left <= span.length() {
                return span.at(left);
            }
            left -= span.length();
        }
        last.end
    }

    /// Where it is at a t that counts the stops, from 0.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec2 {
        let (leg, share) = crate::transition::segment_at(self.legs.len(), t);
        self.place(leg, share)
    }

    fn of(&self, leg: usize) -> &[CurveSpan] {
        let [from, to] = self.legs[leg];
        &self.spans[from..to]
    }
}

/// A line by hand with fewer places: those that are left out were no farther than `off` from what
/// is left (Douglas, Peucker 1973). Its ends stay.
#[must_use]
pub fn thinned(line: &[DVec2], off: f64) -> Vec<DVec2> {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return Vec::new();
    };
    let far = |p: &DVec2| p.distance(first.lerp(last, nearest_segment_parameter(*p, first, last)));
    let within = line.iter().enumerate().take(line.len() - 1).skip(1);
    let worst = within.max_by(|a, b| far(a.1).total_cmp(&far(b.1)));
    match worst {
        Some((k, p)) if far(p) > off => {
            let mut before = thinned(&line[..=k], off);
            before.pop();
            before.extend(thinned(&line[k..], off));
            before
        }
        _ => vec![first, last],
    }
}

/// The cubic from place k − 1 to place k.
fn cubic(places: &[DVec2], k: usize) -> [DVec2; 4] {
    let last = places.len() - 1;
    let is_closed = last > 1 && places[0] == places[last];
    let [from, to] = [places[k - 1], places[k]];
    let before = match k {
        1 if is_closed => places[last - 1],
        1 => from,
        _ => places[k - 2],
    };
    let behind = match k {
        _ if k == last && is_closed => places[1],
        _ if k == last => to,
        _ => places[k + 1],
    };
    // Knots apart by the root of the distance.
    let gap = |a: DVec2, b: DVec2| a.distance(b).sqrt();
    let (left, own, right) = (gap(before, from), gap(from, to), gap(to, behind));
    let chord = to - from;
    let tangent = |other: DVec2, gap: f64| match own > 0.0 && gap > 0.0 {
        // The slopes on both sides, each the more the nearer the other place is, by
        // the width of this span.
        true => (chord * gap / own + other * own / gap) * (own / (own + gap)),
        false => chord,
    };
    let (start, end) = (tangent(from - before, left), tangent(behind - to, right));
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
    fn it_goes_through_its_stops_and_counts_them() {
        let path = path(&[
            (0.0, 0.0, true),
            (0.5, 0.4, true),
            (1.0, 0.0, false),
            (0.3, -0.7, true),
        ]);
        assert_eq!(path.leg_count(), 2);
        let curve = MapCurve::new(&path).expect("a path");
        assert_eq!(curve.leg_count(), 2);
        for (t, k) in [(0.0, 0), (1.0, 2), (2.0, 3)] {
            assert_eq!(curve.at(t), path.places[k].at);
        }
        assert!(MapCurve::new(&MapPath::default()).is_none());
    }

    #[test]
    fn it_runs_evenly_and_smoothly() {
        let path = path(&[
            (0.0, 0.0, false),
            (0.1, 0.5, true),
            (0.9, 0.6, false),
            (1.0, 0.0, false),
        ]);
        let curve = MapCurve::new(&path).expect("a path");
        let places: Vec<DVec2> = (0..=400).map(|k| curve.at(f64::from(k) / 200.0)).collect();
        let steps: Vec<DVec2> = places.windows(2).map(|two| two[1] - two[0]).collect();
        for leg in [&steps[..200], &steps[200..]] {
            let mean = leg.iter().map(|step| step.length()).sum::<f64>() / 200.0;
            let off = |step: &DVec2| (step.length() / mean - 1.0).abs();
            assert!(leg.iter().map(off).fold(0.0, f64::max) < 0.02);
        }
        let turns = steps.windows(2).map(|two| two[0].angle_to(two[1]).abs());
        assert!(turns.fold(0.0, f64::max) < 0.1);
        // Straight on beyond the ends.
        let [before, first] = [curve.at(-0.1), curve.at(0.0)];
        assert!((first - before).angle_to(steps[0]).abs() < 0.05);
    }

    #[test]
    fn one_that_comes_back_is_smooth_where_it_began() {
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
    fn places_in_one_spot_do_no_harm() {
        let path = path(&[(0.2, 0.1, false), (0.2, 0.1, false), (0.4, 0.1, false)]);
        let curve = MapCurve::new(&path).expect("a path");
        for t in [-0.5, 0.0, 0.5, 1.0, 1.5, 2.0] {
            assert!(curve.at(t).is_finite(), "{t}");
        }
        assert_eq!(curve.length(0), 0.0);
    }
}
