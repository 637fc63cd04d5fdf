//! Timeline of a film: the t of each frame. It is also available in a compact form, as linear knots
//! (HTML).

use super::super::film_spec::FilmSpec;
use super::keyframes::fewest_keys;

/// Maximum deviation of linear knots from the t of a frame, as a fraction of the range of t
/// (tolerance: a tenth of a pixel on a path of 1,000 pixels).
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

    /// Returns the difference between the highest and the lowest t.
    fn span(&self) -> f64 {
        let end = |f: fn(f64, f64) -> f64| self.times.iter().copied().reduce(f).unwrap_or(0.0);
        end(f64::max) - end(f64::min)
    }
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
