//! Playback timing: which t is shown after how many seconds. Pure, and shared by window and export.
//!
//! One pass of the film runs from one t to another, with a pause at each end. Stops divide it into
//! segments, each with its own easing; the film may pause at a stop. Time is distributed in
//! proportion to the length in t, except for segments with a duration of their own. Play modes
//! repeat passes.

use crate::settings::named;
use crate::time::EasingFunction;
use serde::{Deserialize, Serialize};

/// Behaviour at the end of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlayMode {
    /// Playback stops.
    Once,
    /// The pass starts again from the beginning.
    Loop,
    /// The next pass runs backwards, and so on.
    #[default]
    PingPong,
}

named! { PlayMode {
    PingPong: "ping-pong", "Ping-pong", "Plays forwards and backwards in turn";
    Loop: "loop", "Loop", "Starts again from the beginning";
    Once: "once", "Once", "Stops at the end";
} }

/// A named moment of a transition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransitionStop {
    /// t of the stop.
    pub t: f64,
    /// Name; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Speaker's note; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Easing from this stop to the next one in t; `None` uses the easing of the film.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub easing: Option<EasingFunction>,
    /// Duration in seconds from this stop to the next one in t, positive; `None` uses the share of
    /// the pass that corresponds to the length in t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_secs: Option<f64>,
    /// Pause at this stop in seconds, not negative; at the ends of a pass, the longer of this pause
    /// and that of the film applies.
    #[serde(default, skip_serializing_if = "is_none")]
    pub hold_secs: f64,
}

fn is_none(secs: &f64) -> bool {
    *secs == 0.0
}

impl TransitionStop {
    /// Creates a stop without a name.
    #[must_use]
    pub fn at(t: f64) -> Self {
        Self {
            t,
            name: String::new(),
            note: String::new(),
            easing: None,
            duration_secs: None,
            hold_secs: 0.0,
        }
    }

    /// Sets the name.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// Sets the pause in seconds.
    #[must_use]
    pub fn resting(self, hold_secs: f64) -> Self {
        Self { hold_secs, ..self }
    }
}

/// How a transition is played over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct Timing {
    /// Duration of a pass in seconds without pauses, positive. Segments with a duration of their
    /// own replace their share of it.
    pub duration_secs: f64,
    /// Easing of each segment whose stop does not set one.
    pub easing: EasingFunction,
    /// Pause at each end in seconds, not negative.
    pub hold_secs: f64,
    /// Behaviour at the end of a pass.
    pub play: PlayMode,
    /// t at the beginning of a pass.
    pub from: f64,
    /// t at the end of a pass; differs from the beginning.
    pub to: f64,
}

/// Why a timing is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TimingError {
    /// The duration is not positive or not finite.
    #[error("the film cannot last {0} seconds; give a positive duration")]
    Duration(f64),
    /// The pause is negative or not finite.
    #[error("a pause cannot last {0} seconds; give 0 or more")]
    Hold(f64),
    /// The ends are equal or not finite.
    #[error("the film cannot run from t = {0} to t = {1}; give two different finite numbers")]
    Range(f64, f64),
    /// A stop is not finite.
    #[error("stop {} has no finite t; correct or remove it", .0 + 1)]
    Stop(usize),
    /// The pause at a stop is negative, or the duration of its segment is not positive.
    #[error("stop {} has an invalid time: give a positive duration and a pause of 0 or more", .0 + 1)]
    StopSecs(usize),
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            duration_secs: 4.0,
            easing: EasingFunction::default(),
            hold_secs: 0.5,
            play: PlayMode::default(),
            from: 0.0,
            to: 1.0,
        }
    }
}

impl Timing {
    /// Checks that the numbers define a pass.
    ///
    /// # Errors
    /// [`TimingError`] for the first invalid number.
    pub fn check(&self, stops: &[TransitionStop]) -> Result<(), TimingError> {
        if !(self.duration_secs.is_finite() && self.duration_secs > 0.0) {
            return Err(TimingError::Duration(self.duration_secs));
        }
        if !(self.hold_secs.is_finite() && self.hold_secs >= 0.0) {
            return Err(TimingError::Hold(self.hold_secs));
        }
        if !(self.from.is_finite() && self.to.is_finite()) || self.from == self.to {
            return Err(TimingError::Range(self.from, self.to));
        }
        if let Some(invalid) = stops.iter().position(|stop| !stop.t.is_finite()) {
            return Err(TimingError::Stop(invalid));
        }
        let is_valid_pause = |secs: f64| secs.is_finite() && secs >= 0.0;
        let is_valid_duration = |secs: f64| secs.is_finite() && secs > 0.0;
        let is_valid = |stop: &TransitionStop| {
            is_valid_pause(stop.hold_secs) && stop.duration_secs.is_none_or(is_valid_duration)
        };
        match stops.iter().position(|stop| !is_valid(stop)) {
            Some(invalid) => Err(TimingError::StopSecs(invalid)),
            None => Ok(()),
        }
    }

    /// Returns the duration of one pass in seconds, pauses included.
    #[must_use]
    pub fn pass_secs(&self, stops: &[TransitionStop]) -> f64 {
        let segments = self
            .segments(stops)
            .map(|segment| segment.secs + segment.rest);
        self.pause_at(self.from, stops) + segments.sum::<f64>()
    }

    /// Returns t after `secs` seconds of a pass; before and after the pass, its ends.
    ///
    /// ```
    /// use morphospace::transition::Timing;
    /// let timing = Timing::default();
    /// assert_eq!(timing.t_at(0.0, &[]), 0.0);
    /// assert_eq!(timing.t_at(timing.pass_secs(&[]), &[]), 1.0);
    /// ```
    #[must_use]
    pub fn t_at(&self, secs: f64, stops: &[TransitionStop]) -> f64 {
        let mut left = secs - self.pause_at(self.from, stops);
        if left <= 0.0 {
            return self.from; // exactly, as during every pause
        }
        for segment in self.segments(stops) {
            if left < segment.secs {
                let x = segment.easing.apply((left / segment.secs).clamp(0.0, 1.0));
                return segment.from + (segment.to - segment.from) * x;
            }
            left -= segment.secs + segment.rest;
            if left < 0.0 {
                return segment.to;
            }
        }
        self.to
    }

    /// Returns the time in seconds at which a pass reaches `t`: the inverse of [`Self::t_at`].
    /// Where the pass pauses, this is the moment of arrival; at the beginning, that of departure.
    #[must_use]
    pub fn secs_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let sign = (self.to - self.from).signum();
        let mut secs = self.pause_at(self.from, stops);
        for segment in self.segments(stops) {
            if sign * t <= sign * segment.to {
                let x = ((t - segment.from) / (segment.to - segment.from)).clamp(0.0, 1.0);
                return secs + segment.secs * segment.easing.inverse(x);
            }
            secs += segment.secs + segment.rest;
        }
        // Beyond the end: the moment of arrival there.
        secs - self.pause_at(self.to, stops)
    }

    /// Returns the easing of the segment that contains `t`, which the stop at its lower end may
    /// set.
    #[must_use]
    pub fn easing_at(&self, t: f64, stops: &[TransitionStop]) -> EasingFunction {
        // A stop belongs to the segment that begins there in the direction of the pass.
        let (begin, end) = self.segment(t, stops);
        self.segment_between(begin, end, stops).easing
    }

    /// Returns the average speed in units of t per second in the segment that contains `t`.
    #[must_use]
    pub fn speed_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let (begin, end) = self.segment(t, stops);
        (end - begin).abs() / self.segment_between(begin, end, stops).secs
    }

    /// Returns the segments of a pass in playing order.
    fn segments<'a>(
        &'a self,
        stops: &'a [TransitionStop],
    ) -> impl Iterator<Item = TimedSegment> + 'a {
        let mut at = Some(self.from);
        std::iter::from_fn(move || {
            let from = at?;
            let (begin, end) = self.segment(from, stops);
            at = (end != self.to).then_some(end);
            Some(self.segment_between(begin, end, stops))
        })
    }

    /// Returns the segment between two neighbouring stops or ends.
    fn segment_between(&self, from: f64, to: f64, stops: &[TransitionStop]) -> TimedSegment {
        // A segment is configured by the stop at its lower end, whichever way the pass runs.
        let low = from.min(to);
        let lower_stop = stops.iter().find(|stop| stop.t == low);
        let share = self.duration_secs * (to - from) / (self.to - self.from);
        TimedSegment {
            from,
            to,
            secs: lower_stop
                .and_then(|stop| stop.duration_secs)
                .unwrap_or(share),
            rest: self.pause_at(to, stops),
            easing: lower_stop
                .and_then(|stop| stop.easing)
                .unwrap_or(self.easing),
        }
    }

    /// Returns the pause in seconds at a stop or an end.
    fn pause_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let stop_here = stops.iter().find(|stop| stop.t == t);
        let own = stop_here.map_or(0.0, |stop| stop.hold_secs);
        let is_end = t == self.from || t == self.to;
        own.max(if is_end { self.hold_secs } else { 0.0 })
    }

    /// Returns the neighbouring stops or ends between which `t` lies, in the direction of the pass;
    /// never equal.
    fn segment(&self, t: f64, stops: &[TransitionStop]) -> (f64, f64) {
        // Negate where the pass runs down, so that t always increases.
        let sign = (self.to - self.from).signum();
        let [from, to, t] = [self.from, self.to, t].map(|t| sign * t);
        let inside = stops.iter().map(|stop| sign * stop.t);
        let inside = inside.filter(|&s| from < s && s < to);
        // A stop belongs to the segment that it begins.
        let before = inside.clone().filter(|&s| s <= t).fold(from, f64::max);
        let after = inside.filter(|&s| s > t).fold(to, f64::min);
        (sign * before, sign * after)
    }
}

/// A segment of a pass, in the direction of playing.
#[derive(Clone, Copy, Debug)]
struct TimedSegment {
    from: f64,
    to: f64,
    /// Duration in seconds.
    secs: f64,
    /// Pause in seconds at the end of the segment.
    rest: f64,
    easing: EasingFunction,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::{EasingBezier, NamedEasing};
    use proptest::prelude::*;

    fn stops(at: &[f64]) -> Vec<TransitionStop> {
        at.iter().copied().map(TransitionStop::at).collect()
    }

    #[test]
    fn a_pass_pauses_departs_arrives_and_pauses() {
        let timing = Timing {
            duration_secs: 2.0,
            hold_secs: 1.0,
            easing: NamedEasing::Linear.into(),
            ..Timing::default()
        };
        let at = |secs| timing.t_at(secs, &[]);
        assert_eq!([at(-1.0), at(0.0), at(1.0)], [0.0; 3]);
        assert_eq!(at(2.0), 0.5);
        assert_eq!([at(3.0), at(4.0), at(99.0)], [1.0; 3]);
        assert_eq!(timing.pass_secs(&[]), 4.0);
    }

    #[test]
    fn each_segment_is_eased_separately() {
        let timing = Timing {
            duration_secs: 1.0,
            hold_secs: 0.0,
            ..Timing::default()
        };
        let stops = stops(&[0.5, 2.0]);
        let slow = timing.t_at(0.51, &stops) - timing.t_at(0.49, &stops);
        let fast = timing.t_at(0.26, &stops) - timing.t_at(0.24, &stops);
        assert!(slow < 0.1 * fast);
        assert_eq!(timing.t_at(0.5, &stops), 0.5);
    }

    #[test]
    fn a_stop_sets_the_easing_of_the_segment_above_it() {
        let mut stops = stops(&[0.5]);
        let curve = EasingBezier::new([0.9, 0.0, 1.0, 0.2]).expect("a curve");
        stops[0].easing = Some(EasingFunction::Bezier(curve));
        let timing = Timing {
            duration_secs: 1.0,
            hold_secs: 0.0,
            easing: NamedEasing::Linear.into(),
            ..Timing::default()
        };
        assert_eq!(timing.t_at(0.25, &stops), 0.25);
        assert!(timing.t_at(0.75, &stops) < 0.6);
        let down = Timing {
            from: 1.0,
            to: 0.0,
            ..timing
        };
        // Backwards, the curve still applies from the beginning of the segment in playing
        // direction.
        assert!(down.t_at(0.25, &stops) > 0.9);
        assert_eq!(down.t_at(0.75, &stops), 0.25);
    }

    #[test]
    fn a_stop_may_have_a_pause_and_a_duration_of_its_own() {
        let timing = Timing {
            duration_secs: 4.0,
            hold_secs: 0.5,
            easing: NamedEasing::Linear.into(),
            to: 2.0,
            ..Timing::default()
        };
        let mut stops = vec![
            TransitionStop::at(1.0).resting(1.0),
            TransitionStop::at(0.0),
        ];
        let at = |secs, stops: &[TransitionStop]| timing.t_at(secs, stops);
        assert_eq!(timing.pass_secs(&stops), 0.5 + 2.0 + 1.0 + 2.0 + 0.5);
        assert_eq!(at(1.5, &stops), 0.5);
        assert_eq!(
            [at(2.5, &stops), at(3.0, &stops), at(3.5, &stops)],
            [1.0; 3]
        );
        assert_eq!(at(4.5, &stops), 1.5);
        assert_eq!(timing.secs_at(1.0, &stops), 2.5);
        assert_eq!(timing.secs_at(1.5, &stops), 4.5);
        assert_eq!(timing.secs_at(7.0, &stops), 5.5);
        stops[0].duration_secs = Some(8.0);
        assert_eq!(timing.pass_secs(&stops), 0.5 + 2.0 + 1.0 + 8.0 + 0.5);
        assert_eq!(at(7.5, &stops), 1.5);
        assert_eq!([0.5, 1.5].map(|t| timing.speed_at(t, &stops)), [0.5, 0.125]);
        let down = Timing {
            from: 2.0,
            to: 0.0,
            ..timing
        };
        assert_eq!(down.pass_secs(&stops), timing.pass_secs(&stops));
        assert_eq!(down.t_at(4.5, &stops), 1.5);
        assert_eq!(down.t_at(9.0, &stops), 1.0);
        stops[0].hold_secs = -1.0;
        assert_eq!(timing.check(&stops), Err(TimingError::StopSecs(0)));
        stops[0] = TransitionStop {
            duration_secs: Some(0.0),
            ..TransitionStop::at(1.0)
        };
        assert_eq!(timing.check(&stops), Err(TimingError::StopSecs(0)));
    }

    #[test]
    fn invalid_numbers_are_refused() {
        let wrong = |edit: fn(&mut Timing)| {
            let mut timing = Timing::default();
            edit(&mut timing);
            timing.check(&[])
        };
        assert_eq!(
            wrong(|t| t.duration_secs = 0.0),
            Err(TimingError::Duration(0.0))
        );
        assert_eq!(wrong(|t| t.hold_secs = -1.0), Err(TimingError::Hold(-1.0)));
        assert_eq!(wrong(|t| t.to = 0.0), Err(TimingError::Range(0.0, 0.0)));
        assert!(wrong(|t| t.from = f64::NAN).is_err());
        assert_eq!(
            Timing::default().check(&stops(&[0.1, f64::NAN])),
            Err(TimingError::Stop(1))
        );
    }

    proptest! {
        #[test]
        fn seconds_and_t_are_inverse_and_monotone(
            secs in 0.0f64..4.0, more in 0.001f64..1.0, easing in 0usize..4,
            at in prop::collection::vec(-0.5f64..1.5, 0..5),
            (own, rest) in (prop::option::of(0.1f64..3.0), 0.0f64..1.0),
            (from, to) in prop_oneof![Just((0.0, 1.0)), Just((1.0, 0.0)), Just((-0.4, 1.3))],
        ) {
            let timing = Timing {
                duration_secs: 4.0, hold_secs: 0.0, easing: NamedEasing::ALL[easing].into(),
                from, to, ..Timing::default()
            };
            let mut stops = stops(&at);
            for stop in stops.iter_mut().step_by(2) {
                (stop.duration_secs, stop.hold_secs) = (own, rest);
            }
            let t = timing.t_at(secs, &stops);
            prop_assert!((timing.t_at(timing.secs_at(t, &stops), &stops) - t).abs() < 1e-9);
            let later = timing.t_at(secs + more, &stops);
            prop_assert!((later - t) * (to - from) >= 0.0);
        }
    }
}
