//! Schedule of a film: the value of t for each frame, the frame rate, and whether it loops.
//!
//! Guarantees: in a pass (once from start to end), the first frame shows exactly the first t, and
//! the last frame exactly the last t. The frames of a selected range keep the times, numbers and
//! delays that they have in the whole film. Nothing is rendered here.

use std::ops::Range;

use crate::transition::{PlayMode, Timing, TransitionStop};

/// Maximum number of frames of a film (resource limit: one hour at 30 frames per second).
pub const MAX_FRAMES: usize = 108_000;

/// Maximum frame rate, in frames per second (resource limit: no display refreshes faster).
pub const MAX_FPS: f64 = 1_000.0;

/// Reason why a film is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilmSpecError {
    /// The frame rate is NaN, at most 0, or above [`MAX_FPS`].
    #[error("a film cannot play {0} frames per second: choose more than 0 and at most {MAX_FPS}")]
    Rate(f64),
    /// There are no frames, or more than [`MAX_FRAMES`].
    #[error("a film cannot have {0} frames: choose at least 1 and at most {MAX_FRAMES}")]
    Count(usize),
    /// A value of t is NaN or infinite.
    #[error("t runs from {from} to {to}: both must be finite numbers")]
    Ends {
        /// First t.
        from: f64,
        /// Last t.
        to: f64,
    },
    /// The range of frames is empty or extends beyond the film.
    #[error(
        "there are no frames {}..{}: the film has {count} frames, numbered 0 to {last}, and the end of a range is exclusive",
        .range.start, .range.end
    )]
    FrameRange {
        /// Requested range of frame numbers.
        range: Range<usize>,
        /// Number of frames of the film.
        count: usize,
        /// Number of the last frame.
        last: usize,
    },
}

/// Consecutive frames that show the same t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRun {
    /// The t that all these frames show.
    pub t: f64,
    /// Number of the first of these frames, counted from 0 within the whole film.
    pub first: usize,
    /// Number of these frames, at least 1.
    pub count: usize,
}

/// Schedule of a film: the t of each frame, the frame rate, whether it loops, its title and its
/// named stops.
///
/// ```
/// use morphospace::export::FilmSpec;
/// let film = FilmSpec::evenly(0.0, 1.0, 5, 25.0)?;
/// assert_eq!(film.times(), [0.0, 0.25, 0.5, 0.75, 1.0]);
/// assert_eq!(film.frame_range(2..4)?.first_number(), 2);
/// # Ok::<(), morphospace::export::FilmSpecError>(())
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
    /// Returns the film that the window plays: one pass with its easing, pauses and stops, followed
    /// by the way back if `timing` is ping-pong.
    ///
    /// # Errors
    /// [`FilmSpecError`] if the frame rate or the number of frames is out of range, or if the first
    /// or the last t is not finite.
    pub fn of_timing(
        timing: &Timing,
        stops: &[TransitionStop],
        fps: f64,
    ) -> Result<Self, FilmSpecError> {
        check(fps, timing.from, timing.to)?;
        let pass_secs = timing.film_secs(stops);
        let steps = (pass_secs * fps).round().max(1.0) as usize;
        // If the number of frames does not fit into an integer, `as` converts it to the largest
        // integer, so even an absurdly long pass is refused here.
        if steps >= MAX_FRAMES {
            return Err(FilmSpecError::Count(steps.saturating_add(1)));
        }
        // Easing can miss `timing.from` and `timing.to` by a rounding error, so the first and the
        // last frame get these values directly.
        let t_of = |i: usize| match i {
            0 => timing.from,
            i if i == steps => timing.to,
            i => timing.t_at(pass_secs * i as f64 / steps as f64, stops),
        };
        let film = Self::new((0..=steps).map(t_of).collect(), fps);
        let named = stops.iter().filter(|stop| !stop.name.is_empty());
        Ok(Self {
            stops: named.map(|stop| (stop.t, stop.name.clone())).collect(),
            ..film.with_play_mode(timing.play)
        })
    }

    /// Returns `count` frames spread evenly from one t to the other, both ends included. A single
    /// frame shows `from`. The film does not loop.
    ///
    /// # Errors
    /// [`FilmSpecError`] if the frame rate or the count is out of range, or if `from` or `to` is
    /// not finite.
    pub fn evenly(from: f64, to: f64, count: usize, fps: f64) -> Result<Self, FilmSpecError> {
        check(fps, from, to)?;
        if count == 0 || count > MAX_FRAMES {
            return Err(FilmSpecError::Count(count));
        }
        Ok(Self::new(even_times(from, to, count), fps))
    }

    /// Applies a play mode to a single pass. Ping-pong appends the way back without the two end
    /// frames, which would otherwise show twice.
    #[must_use]
    pub fn with_play_mode(mut self, play: PlayMode) -> Self {
        self.repeats = play != PlayMode::Once;
        if play == PlayMode::PingPong && self.times.len() > 2 {
            let back = 1..self.times.len() - 1;
            self.times
                .extend(back.rev().map(|i| self.times[i]).collect::<Vec<_>>());
        }
        self
    }

    /// Returns the frames with the given numbers as a separate film; the frames keep their numbers.
    ///
    /// # Errors
    /// [`FilmSpecError::FrameRange`] if the range is empty or extends beyond the film.
    pub fn frame_range(&self, range: Range<usize>) -> Result<Self, FilmSpecError> {
        let end = self.first_number + self.times.len();
        if range.is_empty() || range.start < self.first_number || range.end > end {
            return Err(FilmSpecError::FrameRange {
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

    /// Returns a film with one frame at each of the given values of t, in this order. It does not
    /// loop.
    ///
    /// # Errors
    /// [`FilmSpecError`] if the frame rate or the number of frames is out of range, or if a t is
    /// not finite.
    pub fn at_times(times: Vec<f64>, fps: f64) -> Result<Self, FilmSpecError> {
        for &t in &times {
            check(fps, t, t)?;
        }
        if times.is_empty() || times.len() > MAX_FRAMES {
            return Err(FilmSpecError::Count(times.len()));
        }
        Ok(Self::new(times, fps))
    }

    /// Sets the title. Formats without titles ignore it.
    #[must_use]
    pub fn with_title(self, title: impl Into<String>) -> Self {
        Self {
            title: Some(title.into()).filter(|title: &String| !title.is_empty()),
            ..self
        }
    }

    /// Returns the title of the film.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// Returns the named stops of the film, each with its t.
    pub fn stops(&self) -> &[(f64, String)] {
        &self.stops
    }

    /// Returns the t of each frame.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of the first frame: 0 for a whole film, possibly more for a range of
    /// frames.
    pub fn first_number(&self) -> usize {
        self.first_number
    }

    /// Returns the number of frames per second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// Returns whether the film loops.
    pub fn repeats(&self) -> bool {
        self.repeats
    }

    /// Returns the runs of the film: groups of consecutive frames with equal t, for example during
    /// a pause, so that each group is drawn once.
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

    /// Returns the duration of a run in whole ticks of 1 / `ticks_per_sec` seconds. The start and
    /// the end of the run are rounded, not its duration, so that rounding errors do not accumulate
    /// over the film.
    pub fn ticks(&self, run: FrameRun, ticks_per_sec: f64) -> u64 {
        // Ticks are counted from the start of the whole film, so that ranges of it join without
        // gaps.
        let tick_at = |number: usize| (number as f64 * ticks_per_sec / self.fps).round() as u64;
        tick_at(run.first + run.count) - tick_at(run.first)
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

/// Returns `count` values spread evenly from `from` to `to`, both ends exact. A single value is
/// `from`.
pub fn even_times(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let t_of = |i: usize| {
        let s = i as f64 / last as f64;
        // This form is exact at both ends, unlike from + s (to − from).
        (1.0 - s) * from + s * to
    };
    (0..count).map(t_of).collect()
}

/// Checks the frame rate, and that the first and the last t are finite.
fn check(fps: f64, from: f64, to: f64) -> Result<(), FilmSpecError> {
    // The negated condition is true for NaN, so NaN is refused too.
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
    fn a_pass_shows_both_ends_exactly_and_pauses_there() {
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
    fn ping_pong_returns_without_repeating_the_ends() {
        let once = FilmSpec::evenly(0.0, 1.0, 4, 10.0).expect("a film");
        let film = once.clone().with_play_mode(PlayMode::PingPong);
        let [a, b, c, d] = once.times() else {
            panic!("expected four frames");
        };
        assert_eq!(film.times(), [*a, *b, *c, *d, *c, *b]);
        assert!(film.repeats());
        let short = FilmSpec::evenly(0.0, 1.0, 2, 10.0).expect("a film");
        assert_eq!(short.with_play_mode(PlayMode::PingPong).times(), [0.0, 1.0]);
    }

    #[test]
    fn ranges_join_to_the_whole_film() {
        let film = FilmSpec::of_timing(&timing(PlayMode::PingPong), &[], 7.0).expect("a film");
        let n = film.times().len();
        let parts = [0..3, 3..n - 1, n - 1..n].map(|r| film.frame_range(r).expect("a part"));
        let times: Vec<f64> = parts.iter().flat_map(|p| p.times().to_vec()).collect();
        assert_eq!(times, film.times());
        let ticks =
            |film: &FilmSpec| -> u64 { film.runs().iter().map(|&r| film.ticks(r, 100.0)).sum() };
        assert_eq!(parts.iter().map(ticks).sum::<u64>(), ticks(&film));
        assert_eq!(parts[1].first_number(), 3);
        let of_part = parts[1].frame_range(4..5).expect("a part of a part");
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
    fn invalid_rates_counts_and_ranges_are_refused() {
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
            assert!(matches!(
                film.frame_range(range),
                Err(FilmSpecError::FrameRange { .. })
            ));
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
