//! Which t is shown when.

use super::super::film_spec::FilmSpec;
use super::keyframes::fewest_keys;

/// How exactly t is told, as a share of the way: a tenth of a pixel on a way of a
/// thousand.
const NEAR: f64 = 1e-4;

/// The t of a film over its frames, and how it goes on at its end.
#[derive(Clone, Debug)]
pub(super) struct FilmTimeline {
    /// The t of each frame; at the end that of the one that follows, or the last once
    /// more.
    pub times: Vec<f64>,
    pub fps: f64,
    pub repeats: bool,
    /// Frames of one pass.
    pub pass: usize,
}

impl FilmTimeline {
    pub(super) fn of(film: &FilmSpec) -> Self {
        let mut times = film.times().to_vec();
        let n = times.len();
        let comes_back = film.repeats() && n > 2 && (1..n).all(|k| times[k] == times[n - k]);
        // The way back leads to the first frame; all else rests at the last.
        times.push(if comes_back { times[0] } else { times[n - 1] });
        Self {
            times,
            fps: film.fps(),
            repeats: film.repeats(),
            pass: if comes_back { n / 2 } else { (n - 1).max(1) },
        }
    }

    /// Frames of the whole film.
    pub(super) fn frames(&self) -> usize {
        self.times.len() - 1
    }

    /// Its length.
    pub(super) fn secs(&self) -> f64 {
        self.frames() as f64 / self.fps
    }

    /// Numbers of frames and their t, between which t runs evenly.
    pub(super) fn knots(&self) -> Vec<(usize, f64)> {
        let places: Vec<f64> = (0..self.times.len()).map(|k| k as f64).collect();
        let rows: Vec<Vec<f64>> = self.times.iter().map(|&t| vec![t]).collect();
        let keys = fewest_keys(&places, &rows, NEAR * self.span());
        keys.into_iter().map(|k| (k, self.times[k])).collect()
    }

    /// The same by cubic curves, of which fewer are needed: easings are such.
    pub(super) fn curves(&self) -> Vec<TimelineCurve> {
        let near = NEAR * self.span();
        let last = self.frames();
        let mut curves = Vec::new();
        let mut from = 0;
        while from < last {
            let mut best = (
                from + 1,
                TimelineCurve::through(&self.times[from..=from + 1], near),
            );
            for to in from + 2..=last {
                match TimelineCurve::through(&self.times[from..=to], near) {
                    Some(curve) => best = (to, Some(curve)),
                    // A rest that is left, or a way that turns: no longer one has it.
                    None => break,
                }
            }
            let (to, curve) = best;
            let curve = curve.unwrap_or_default();
            curves.push(TimelineCurve { from, to, ..curve });
            from = to;
        }
        curves
    }

    /// How far the lowest and the highest t are apart.
    fn span(&self) -> f64 {
        let end = |f: fn(f64, f64) -> f64| self.times.iter().copied().reduce(f).unwrap_or(0.0);
        end(f64::max) - end(f64::min)
    }
}

/// What keeps the handles where they are if nothing moves them.
const RIDGE: f64 = 1e-9;

/// How t runs from one frame to another, both told as 0 to 1: a Bézier curve whose
/// handles lie at a third and at two thirds of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TimelineCurve {
    pub from: usize,
    pub to: usize,
    /// How high its handles are.
    pub handles: [f64; 2],
}

impl Default for TimelineCurve {
    /// The straight one.
    fn default() -> Self {
        Self {
            from: 0,
            to: 0,
            handles: [1.0 / 3.0, 2.0 / 3.0],
        }
    }
}

impl TimelineCurve {
    /// One that passes the values at even times so near, if there is one.
    fn through(values: &[f64], near: f64) -> Option<Self> {
        let (&first, &last) = (values.first()?, values.last()?);
        let rise = last - first;
        let steps = (values.len() - 1) as f64;
        if rise == 0.0 {
            return values.iter().all(|&v| v == first).then(Self::default);
        }
        // The handles by least squares of what the straight line leaves; where there are
        // fewer values than handles, those that lie next to its own.
        let straight = Self::default();
        let (mut a, mut b, mut c, mut p, mut q) = (RIDGE, 0.0, RIDGE, 0.0, 0.0);
        for (k, v) in values.iter().enumerate() {
            let u = k as f64 / steps;
            let [f, g] = bells(u);
            let rest = (v - first) / rise - straight.at(u);
            (a, b, c) = (a + f * f, b + f * g, c + g * g);
            (p, q) = (p + f * rest, q + g * rest);
        }
        let determinant = a * c - b * b;
        let handles = [
            straight.handles[0] + (c * p - b * q) / determinant,
            straight.handles[1] + (a * q - b * p) / determinant,
        ];
        let curve = Self {
            handles,
            ..Self::default()
        };
        let is_near =
            |(k, v): (usize, &f64)| (first + rise * curve.at(k as f64 / steps) - v).abs() <= near;
        values.iter().enumerate().all(is_near).then_some(curve)
    }

    fn at(&self, u: f64) -> f64 {
        let [f, g] = bells(u);
        self.handles[0] * f + self.handles[1] * g + u.powi(3)
    }
}

/// Bernstein's polynomials of the two handles.
fn bells(u: f64) -> [f64; 2] {
    [3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transition::{PlayMode, Timing};

    #[test]
    fn knots_tell_every_frame_and_there_are_few() {
        let film = FilmSpec::of_timing(&Timing::default(), &[], 30.0).expect("a film");
        let course = FilmTimeline::of(&film);
        let knots = course.knots();
        assert!(knots.len() < 200, "{}", knots.len());
        // Two rests, two ways.
        assert!(course.curves().len() <= 6, "{:?}", course.curves());
        for (k, &t) in course.times.iter().enumerate() {
            let after = knots
                .partition_point(|knot| knot.0 <= k)
                .min(knots.len() - 1);
            let [(a, from), (b, to)] = [knots[after - 1], knots[after]];
            let s = (k - a) as f64 / (b - a) as f64;
            assert!((from * (1.0 - s) + to * s - t).abs() <= NEAR + 1e-12);
        }
    }

    #[test]
    fn the_way_back_is_told_from_a_pass() {
        let once = FilmSpec::evenly(0.0, 1.0, 5, 10.0).expect("a film");
        let course = FilmTimeline::of(&once);
        assert_eq!((course.pass, course.frames()), (4, 5));
        assert_eq!(course.times[5], 1.0);
        let back = FilmTimeline::of(&once.playing(PlayMode::PingPong));
        assert_eq!((back.pass, back.frames()), (4, 8));
        assert_eq!(back.times[8], 0.0);
    }
}
