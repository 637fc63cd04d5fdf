//! Timeline of a film: the t of each frame. It is also available in two compact forms: linear knots
//! (HTML) and cubic curves (Lottie).

use super::super::film_spec::FilmSpec;
use super::keyframes::fewest_keys;

/// Maximum deviation of linear knots and cubic curves from the t of a frame, as a fraction of the
/// range of t (tolerance: a tenth of a pixel on a path of 1,000 pixels).
const TIME_TOLERANCE: f64 = 1e-4;

/// The t of each frame of a film, and how the film continues at its end.
#[derive(Clone, Debug)]
pub(super) struct FilmTimeline {
    /// Value of t of each frame, followed by one more for the end of the last frame: the t of the
    /// first frame if the film plays back to it, otherwise that of the last frame again.
    pub times: Vec<f64>,
    /// Frames per second.
    pub fps: f64,
    /// Whether the film loops.
    pub repeats: bool,
}

impl FilmTimeline {
    /// Creates the timeline of a film. A looping film whose times are symmetric plays ping-pong.
    pub(super) fn of(film: &FilmSpec) -> Self {
        let mut times = film.times().to_vec();
        let n = times.len();
        let comes_back = film.repeats() && n > 2 && (1..n).all(|k| times[k] == times[n - k]);
        // A ping-pong film returns to its first t at the end; any other film stays at its last t.
        times.push(if comes_back { times[0] } else { times[n - 1] });
        Self {
            times,
            fps: film.fps(),
            repeats: film.repeats(),
        }
    }

    /// Returns the number of frames of the whole film.
    pub(super) fn frames(&self) -> usize {
        self.times.len() - 1
    }

    /// Returns the duration of the film in seconds.
    pub(super) fn secs(&self) -> f64 {
        self.frames() as f64 / self.fps
    }

    /// Returns the fewest frame numbers, with their t, between which linear interpolation of t is
    /// accurate enough.
    pub(super) fn linear_knots(&self) -> Vec<(usize, f64)> {
        let places: Vec<f64> = (0..self.times.len()).map(|k| k as f64).collect();
        let rows: Vec<Vec<f64>> = self.times.iter().map(|&t| vec![t]).collect();
        let keys = fewest_keys(&places, &rows, TIME_TOLERANCE * self.span());
        keys.into_iter().map(|k| (k, self.times[k])).collect()
    }

    /// Returns the timeline as consecutive cubic curves. Fewer curves than linear knots are needed,
    /// because easings are cubic or nearly cubic.
    pub(super) fn curves(&self) -> Vec<TimelineCurve> {
        let tolerance = TIME_TOLERANCE * self.span();
        let last = self.frames();
        let mut curves = Vec::new();
        let mut from = 0;
        while from < last {
            let mut best = (
                from + 1,
                TimelineCurve::through(&self.times[from..=from + 1], tolerance),
            );
            for to in from + 2..=last {
                match TimelineCurve::through(&self.times[from..=to], tolerance) {
                    Some(curve) => best = (to, Some(curve)),
                    // Longer stretches contain the end of a pause or a reversal, so no single curve
                    // fits them either.
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

    /// Returns the difference between the highest and the lowest t.
    fn span(&self) -> f64 {
        let end = |f: fn(f64, f64) -> f64| self.times.iter().copied().reduce(f).unwrap_or(0.0);
        end(f64::max) - end(f64::min)
    }
}

/// Regularisation weight of the least-squares fit of the two handles of a cubic Bézier curve
/// (tolerance: if there are too few values to determine the handles, they become those of a
/// straight line).
const RIDGE: f64 = 1e-9;

/// Cubic Bézier curve of t over time, from one frame to another. Time and t are both normalised to
/// [0, 1]; the handles are at one third and two thirds of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TimelineCurve {
    /// Number of the first frame of the curve.
    pub from: usize,
    /// Number of the last frame of the curve.
    pub to: usize,
    /// Normalised t of the two handles, at one third and two thirds of the time.
    pub handles: [f64; 2],
}

impl Default for TimelineCurve {
    /// Returns the straight line from (0, 0) to (1, 1).
    fn default() -> Self {
        Self {
            from: 0,
            to: 0,
            handles: [1.0 / 3.0, 2.0 / 3.0],
        }
    }
}

impl TimelineCurve {
    /// Fits a curve through values at uniform times; `None` if a deviation exceeds `tolerance`.
    fn through(values: &[f64], tolerance: f64) -> Option<Self> {
        let (&first, &last) = (values.first()?, values.last()?);
        let rise = last - first;
        let steps = (values.len() - 1) as f64;
        if rise == 0.0 {
            return values.iter().all(|&v| v == first).then(Self::default);
        }
        // The unknowns are the offsets of the handles from those of a straight line. They minimise
        // the sum of squared deviations from the values. With fewer values than handles, the
        // regularisation keeps the offsets close to 0.
        let straight = Self::default();
        let (mut a, mut b, mut c, mut p, mut q) = (RIDGE, 0.0, RIDGE, 0.0, 0.0);
        for (k, v) in values.iter().enumerate() {
            let u = k as f64 / steps;
            let [f, g] = handle_weights(u);
            let residual = (v - first) / rise - straight.at(u);
            (a, b, c) = (a + f * f, b + f * g, c + g * g);
            (p, q) = (p + f * residual, q + g * residual);
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
        let is_near = |(k, v): (usize, &f64)| {
            (first + rise * curve.at(k as f64 / steps) - v).abs() <= tolerance
        };
        values.iter().enumerate().all(is_near).then_some(curve)
    }

    /// Returns the normalised t at the normalised time `u`.
    fn at(&self, u: f64) -> f64 {
        let [f, g] = handle_weights(u);
        self.handles[0] * f + self.handles[1] * g + u.powi(3)
    }
}

/// Returns the values at `u` of the cubic Bernstein polynomials of the two handles.
fn handle_weights(u: f64) -> [f64; 2] {
    [3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transition::{PlayMode, Timing};

    #[test]
    fn few_knots_reproduce_every_frame() {
        let film = FilmSpec::of_timing(&Timing::default(), &[], 30.0).expect("a film");
        let timeline = FilmTimeline::of(&film);
        let knots = timeline.linear_knots();
        assert!(knots.len() < 200, "{}", knots.len());
        // The film has two pauses and two passes; more than six curves would be wasteful.
        assert!(timeline.curves().len() <= 6, "{:?}", timeline.curves());
        for (k, &t) in timeline.times.iter().enumerate() {
            let after = knots
                .partition_point(|knot| knot.0 <= k)
                .min(knots.len() - 1);
            let [(a, from), (b, to)] = [knots[after - 1], knots[after]];
            let s = (k - a) as f64 / (b - a) as f64;
            assert!((from * (1.0 - s) + to * s - t).abs() <= TIME_TOLERANCE + 1e-12);
        }
    }

    #[test]
    fn the_way_back_of_a_ping_pong_film_is_recognised() {
        let once = FilmSpec::evenly(0.0, 1.0, 5, 10.0).expect("a film");
        let timeline = FilmTimeline::of(&once);
        assert_eq!(timeline.frames(), 5);
        assert_eq!(timeline.times[5], 1.0);
        let back = FilmTimeline::of(&once.with_play_mode(PlayMode::PingPong));
        assert_eq!(back.frames(), 8);
        assert_eq!(back.times[8], 0.0);
    }
}
