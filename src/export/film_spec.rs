//! Which values of t a film shows, in which order and at what rate.
//!
//! Guarantees: the first frame is exactly the first t and the last frame of a
//! pass exactly the last one; a part of a film has the same frames, numbers
//! and delays as the whole. Nothing is rendered here.

use std::ops::Range;

use crate::transition::{PlayMode, Timing, TransitionStop};

/// The most frames of one film: an hour at 30 frames a second.
pub const MAX_FRAMES: usize = 108_000;

/// The highest frame rate, in frames a second.
pub const MAX_FPS: f64 = 1_000.0;

/// Why a film cannot be had.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilmSpecError {
    /// A frame rate of nothing, or beyond [`MAX_FPS`].
    #[error("a film cannot run at {0} frames a second: choose more than 0 and at most {MAX_FPS}")]
    Rate(f64),
    /// No frames at all, or more than [`MAX_FRAMES`].
    #[error("a film of {0} frames cannot be made: it needs at least 1 and at most {MAX_FRAMES}")]
    Count(usize),
    /// A t that is no number.
    #[error("t runs from {from} to {to}: both must be finite numbers")]
    Ends {
        /// First t.
        from: f64,
        /// Last t.
        to: f64,
    },
    /// A part that is empty or beyond the film's end.
    #[error(
        "there are no frames {}..{}: the film has {count}, numbered 0 to {last}, and the end of a range is not part of it",
        .range.start, .range.end
    )]
    Part {
        /// The part asked for.
        range: Range<usize>,
        /// The film's number of frames.
        count: usize,
        /// The film's last number.
        last: usize,
    },
}

/// Frames that show the same t and follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRun {
    /// What they show.
    pub t: f64,
    /// Number of the first of them within the whole film.
    pub first: usize,
    /// How many there are, at least 1.
    pub count: usize,
}

/// The t of each frame, the rate, and whether the film starts again at its end.
///
/// ```
/// use morphospace::export::Film;
/// let film = Film::evenly(0.0, 1.0, 5, 25.0)?;
/// assert_eq!(film.times(), [0.0, 0.25, 0.5, 0.75, 1.0]);
/// assert_eq!(film.part(2..4)?.first_number(), 2);
/// # Ok::<(), morphospace::export::FilmError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSpec {
    times: Vec<f64>,
    first_number: usize,
    fps: f64,
    repeats: bool,
    title: Option<String>,
    stops: Vec<(f64, String)>,
}

impl FilmSpec {
    /// The film that the window plays: one pass with its easing, holds and
    /// stops, and the way back where it plays ping-pong.
    ///
    /// # Errors
    /// [`FilmSpecError`] for a rate or a length that cannot be had.
    pub fn of_timing(
        timing: &Timing,
        stops: &[TransitionStop],
        fps: f64,
    ) -> Result<Self, FilmSpecError> {
        check(fps, timing.from, timing.to)?;
        let pass_secs = timing.pass_secs(stops);
        let steps = (pass_secs * fps).round().max(1.0) as usize;
        // `as` saturates: a pass of aeons, too, ends here.
        if steps >= MAX_FRAMES {
            return Err(FilmSpecError::Count(steps.saturating_add(1)));
        }
        // An easing may miss the ends by rounding; the first and the last frame
        // do not.
        let t_of = |i: usize| match i {
            0 => timing.from,
            i if i == steps => timing.to,
            i => timing.t_at(pass_secs * i as f64 / steps as f64, stops),
        };
        let film = Self::new((0..=steps).map(t_of).collect(), fps);
        let named = stops.iter().filter(|stop| !stop.name.is_empty());
        Ok(Self {
            stops: named.map(|stop| (stop.t, stop.name.clone())).collect(),
            ..film.playing(timing.play)
        })
    }

    /// `count` frames evenly from one t to the other, both ends included; a
    /// single frame shows `from`. It runs once.
    ///
    /// # Errors
    /// [`FilmSpecError`] for a rate, a count or a t that cannot be had.
    pub fn evenly(from: f64, to: f64, count: usize, fps: f64) -> Result<Self, FilmSpecError> {
        check(fps, from, to)?;
        if count == 0 || count > MAX_FRAMES {
            return Err(FilmSpecError::Count(count));
        }
        Ok(Self::new(even_times(from, to, count), fps))
    }

    /// The same pass, as it plays: ping-pong adds the way back, without the two
    /// ends, which would show twice.
    #[must_use]
    pub fn playing(mut self, play: PlayMode) -> Self {
        self.repeats = play != PlayMode::Once;
        if play == PlayMode::PingPong && self.times.len() > 2 {
            let back = 1..self.times.len() - 1;
            self.times
                .extend(back.rev().map(|i| self.times[i]).collect::<Vec<_>>());
        }
        self
    }

    /// The frames with the given numbers, as a film that keeps the numbers.
    ///
    /// # Errors
    /// [`FilmSpecError::Part`] where the range is empty or leaves the film.
    pub fn part(&self, range: Range<usize>) -> Result<Self, FilmSpecError> {
        let end = self.first_number + self.times.len();
        if range.is_empty() || range.start < self.first_number || range.end > end {
            return Err(FilmSpecError::Part {
                range,
                count: self.times.len(),
                last: end - 1,
            });
        }
        let first = self.first_number;
        Ok(Self {
            times: self.times[range.start - first..range.end - first].to_vec(),
            first_number: range.start,
            ..self.clone()
        })
    }

    /// Frames at these t, in this order. It runs once.
    ///
    /// # Errors
    /// [`FilmSpecError`] for a rate, a number of frames or a t that cannot be had.
    pub fn at(times: Vec<f64>, fps: f64) -> Result<Self, FilmSpecError> {
        for &t in &times {
            check(fps, t, t)?;
        }
        if times.is_empty() || times.len() > MAX_FRAMES {
            return Err(FilmSpecError::Count(times.len()));
        }
        Ok(Self::new(times, fps))
    }

    /// The same under a title; formats that know none do without.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: Some(title.into()).filter(|title: &String| !title.is_empty()),
            ..self
        }
    }

    /// What it is called.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// The stops of its timing that have a name, each with its t.
    pub fn stops(&self) -> &[(f64, String)] {
        &self.stops
    }

    /// The t of each frame.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The number of the first frame: 0, or more for a part.
    pub fn first_number(&self) -> usize {
        self.first_number
    }

    /// Frames a second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// Whether the film starts again at its end.
    pub fn repeats(&self) -> bool {
        self.repeats
    }

    /// The frames with equal neighbours taken together (holds, for example), so
    /// that each is drawn once.
    pub fn runs(&self) -> Vec<FrameRun> {
        let mut first = self.first_number;
        let run_of = |ts: &[f64]| {
            let run = FrameRun {
                t: ts[0],
                first,
                count: ts.len(),
            };
            first += ts.len();
            run
        };
        self.times.chunk_by(|a, b| a == b).map(run_of).collect()
    }

    /// How long a run stays, in whole ticks of which `ticks_per_sec` make a
    /// second. Ends are rounded, not lengths, so nothing drifts.
    pub fn ticks(&self, run: FrameRun, ticks_per_sec: f64) -> u64 {
        // By the number in the whole film, so that parts fit together.
        let at = |number: usize| (number as f64 * ticks_per_sec / self.fps).round() as u64;
        at(run.first + run.count) - at(run.first)
    }

    fn new(times: Vec<f64>, fps: f64) -> Self {
        Self {
            times,
            first_number: 0,
            fps,
            repeats: false,
            title: None,
            stops: Vec::new(),
        }
    }
}

/// `count` values evenly from `from` to `to`, met exactly; one value is `from`.
pub fn even_times(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let t_of = |i: usize| {
        let s = i as f64 / last as f64;
        // Exact at both ends, which from + s (to − from) is not.
        (1.0 - s) * from + s * to
    };
    (0..count).map(t_of).collect()
}

fn check(fps: f64, from: f64, to: f64) -> Result<(), FilmSpecError> {
    // Asked this way round NaN is refused.
    if !(fps > 0.0 && fps <= MAX_FPS) {
        return Err(FilmSpecError::Rate(fps));
    }
    if !(from.is_finite() && to.is_finite()) {
        return Err(FilmSpecError::Ends { from, to });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing(play: PlayMode) -> Timing {
        Timing {
            duration_secs: 2.0,
            hold_secs: 0.5,
            play,
            ..Timing::default()
        }
    }

    #[test]
    fn a_pass_meets_both_ends_and_holds_them() {
        let film = FilmSpec::of_timing(&timing(PlayMode::Once), &[], 10.0).expect("a film");
        assert_eq!(film.times().len(), 31);
        assert_eq!(film.times()[0], 0.0);
        assert_eq!(film.times()[30], 1.0);
        let runs = film.runs();
        assert!(
            runs[0].count >= 5 && runs[runs.len() - 1].count >= 5,
            "{runs:?}"
        );
        assert!(!film.repeats());
        assert!(film.times().is_sorted());
    }

    #[test]
    fn ping_pong_comes_back_without_showing_an_end_twice() {
        let once = FilmSpec::evenly(0.0, 1.0, 4, 10.0).expect("a film");
        let film = once.clone().playing(PlayMode::PingPong);
        let [a, b, c, d] = once.times() else {
            panic!("four frames were asked for");
        };
        assert_eq!(film.times(), [*a, *b, *c, *d, *c, *b]);
        assert!(film.repeats());
        let short = FilmSpec::evenly(0.0, 1.0, 2, 10.0).expect("a film");
        assert_eq!(short.playing(PlayMode::PingPong).times(), [0.0, 1.0]);
    }

    #[test]
    fn parts_make_the_whole() {
        let film = FilmSpec::of_timing(&timing(PlayMode::PingPong), &[], 7.0).expect("a film");
        let n = film.times().len();
        let parts = [0..3, 3..n - 1, n - 1..n].map(|r| film.part(r).expect("a part"));
        let times: Vec<f64> = parts.iter().flat_map(|p| p.times().to_vec()).collect();
        assert_eq!(times, film.times());
        let ticks =
            |film: &FilmSpec| -> u64 { film.runs().iter().map(|&r| film.ticks(r, 100.0)).sum() };
        assert_eq!(parts.iter().map(ticks).sum::<u64>(), ticks(&film));
        assert_eq!(parts[1].first_number(), 3);
        let of_part = parts[1].part(4..5).expect("a part of a part");
        assert_eq!(of_part.times(), &film.times()[4..5]);
    }

    #[test]
    fn delays_do_not_drift() {
        let film = FilmSpec::evenly(0.0, 1.0, 300, 30.0).expect("a film");
        let delays: Vec<u64> = film.runs().iter().map(|&r| film.ticks(r, 100.0)).collect();
        assert_eq!(delays.iter().sum::<u64>(), 1000);
        assert!(delays.iter().all(|d| (3..=4).contains(d)));
        assert_eq!(delays[..3].iter().sum::<u64>(), 10);
    }

    #[test]
    fn nonsense_is_refused() {
        for fps in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            assert!(matches!(
                FilmSpec::evenly(0.0, 1.0, 2, fps),
                Err(FilmSpecError::Rate(_))
            ));
        }
        assert!(matches!(
            FilmSpec::evenly(0.0, 1.0, 0, 1.0),
            Err(FilmSpecError::Count(0))
        ));
        assert!(matches!(
            FilmSpec::evenly(0.0, f64::NAN, 2, 1.0),
            Err(FilmSpecError::Ends { .. })
        ));
        let film = FilmSpec::evenly(0.0, 1.0, 5, 1.0).expect("a film");
        for range in [0..0, 3..6, 5..6, 9..12] {
            assert!(matches!(film.part(range), Err(FilmSpecError::Part { .. })));
        }
        let endless = Timing {
            duration_secs: 1e12,
            ..Timing::default()
        };
        assert!(matches!(
            FilmSpec::of_timing(&endless, &[], 30.0),
            Err(FilmSpecError::Count(_))
        ));
    }
}
