//! Which t is shown when.

use super::super::film::Film;
use super::keys::fewest;

/// How exactly t is told, as a share of the way: a tenth of a pixel on a way of a
/// thousand.
const NEAR: f64 = 1e-4;

/// The t of a film over its frames, and how it goes on at its end.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The t of each frame; at the end that of the one that follows, or the last once
    /// more.
    pub times: Vec<f64>,
    pub fps: f64,
    pub repeats: bool,
    /// Frames of one pass.
    pub pass: usize,
}

impl Course {
    pub(super) fn of(film: &Film) -> Self {
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
        let span = |f: fn(f64, f64) -> f64| self.times.iter().copied().reduce(f).unwrap_or(0.0);
        let tolerance = NEAR * (span(f64::max) - span(f64::min));
        let keys = fewest(&places, &rows, tolerance);
        keys.into_iter().map(|k| (k, self.times[k])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transition::{PlayMode, Timing};

    #[test]
    fn knots_tell_every_frame_and_there_are_few() {
        let film = Film::of_timing(&Timing::default(), &[], 30.0).expect("a film");
        let course = Course::of(&film);
        let knots = course.knots();
        assert!(knots.len() < 80, "{}", knots.len());
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
        let once = Film::evenly(0.0, 1.0, 5, 10.0).expect("a film");
        let course = Course::of(&once);
        assert_eq!((course.pass, course.frames()), (4, 5));
        assert_eq!(course.times[5], 1.0);
        let back = Course::of(&once.playing(PlayMode::PingPong));
        assert_eq!((back.pass, back.frames()), (4, 8));
        assert_eq!(back.times[8], 0.0);
    }
}
