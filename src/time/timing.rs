//! Playback timing: which t is shown after how many seconds. The window and the export share it.
//!
//! One pass of the animation runs from one t to another and pauses at each end. Stops divide it
//! into segments, each with its own easing; the animation may pause at a stop. The duration of a
//! pass is distributed over its segments in proportion to their lengths in t, except that a segment
//! may have a separate duration. The play mode determines how passes are repeated.

use crate::settings::named;
use crate::time::EasingFunction;
use serde::{Deserialize, Serialize};

/// Behaviour at the end of a pass of the animation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlayMode {
    /// Playback stops at the end of the pass.
    Once,
    /// The pass starts again from its beginning.
    Loop,
    /// The next pass runs backwards, the one after it forwards, and so on.
    #[default]
    PingPong,
}

named! { PlayMode {
    PingPong: "ping-pong", "Ping-pong", "Plays forwards and backwards in turn";
    Loop: "loop", "Loop", "Starts again from the beginning";
    Once: "once", "Once", "Stops at the end";
} }

/// Stop: a named moment of a transition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransitionStop {
    /// The t of the stop.
    pub t: f64,
    /// Name of the stop; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Speaker's note; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Easing from this stop to the next one in ascending t; `None` uses that of the [`Timing`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub easing: Option<EasingFunction>,
    /// Duration in seconds from this stop to the next one in ascending t, positive. `None` gives
    /// the segment a share of the pass's duration in proportion to its length in t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_secs: Option<f64>,
    /// Pause at this stop in seconds, not negative. If the stop is at an end of a pass, the longer
    /// of this pause and the pause of the [`Timing`] applies.
    #[serde(default, skip_serializing_if = "is_none")]
    pub hold_secs: f64,
}

fn is_none(secs: &f64) -> bool {
    *secs == 0.0
}

impl TransitionStop {
    /// Creates a stop at `t` without a name, a pause or settings.
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

    /// Sets the name of the stop.
    #[must_use]
    pub fn with_name(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// Sets the pause at the stop, in seconds.
    #[must_use]
    pub fn with_pause(self, hold_secs: f64) -> Self {
        Self { hold_secs, ..self }
    }
}

/// Timing of a transition: how it is played over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct Timing {
    /// Duration of a pass in seconds without pauses, positive. A segment with a separate duration
    /// takes that time instead of its share.
    pub duration_secs: f64,
    /// Easing of each segment, unless the stop at its smaller t has a separate easing.
    pub easing: EasingFunction,
    /// Pause at each end of a pass in seconds, not negative.
    pub hold_secs: f64,
    /// Behaviour at the end of a pass.
    pub play: PlayMode,
    /// The t at the beginning of a pass.
    pub from: f64,
    /// The t at the end of a pass; differs from `from`.
    pub to: f64,
}

/// Reason why a timing is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TimingError {
    /// The duration is not positive or not finite.
    #[error("the film cannot last {0} seconds; give a positive duration")]
    Duration(f64),
    /// The pause at the ends of a pass is negative or not finite.
    #[error("a pause cannot last {0} seconds; give 0 or more")]
    Hold(f64),
    /// The values of t at the ends of a pass are equal or not finite.
    #[error("the film cannot run from t = {0} to t = {1}; give two different finite numbers")]
    Range(f64, f64),
    /// The stop with this index has a t that is not finite.
    #[error("stop {} has no finite t; correct or remove it", .0 + 1)]
    Stop(usize),
    /// At the stop with this index, the pause is negative or the duration of the segment is not
    /// positive, or one of them is not finite.
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
    /// Checks that the numbers of this timing and of the stops are valid.
    ///
    /// # Errors
    /// [`TimingError`] names the first invalid number.
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
    pub fn film_secs(&self, stops: &[TransitionStop]) -> f64 {
        let segments = self
            .segments(stops)
            .map(|segment| segment.secs + segment.pause_secs);
        self.pause_at(self.from, stops) + segments.sum::<f64>()
    }

    /// Returns the t that is shown `secs` seconds after the start of a pass. Before and after the
    /// pass this is the t of its beginning or its end.
    ///
    /// ```
    /// use morphospace::transition::Timing;
    /// let timing = Timing::default();
    /// assert_eq!(timing.t_at(0.0, &[]), 0.0);
    /// assert_eq!(timing.t_at(timing.film_secs(&[]), &[]), 1.0);
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
            left -= segment.secs + segment.pause_secs;
            if left < 0.0 {
                return segment.to;
            }
        }
        self.to
    }

    /// Returns the time in seconds at which a pass reaches `t`: the inverse of [`Self::t_at`]. If
    /// the pass pauses at `t`, the result is the time at which the pause begins, except for the
    /// pause at the beginning of the pass: there it is the time at which the pause ends.
    #[must_use]
    pub fn secs_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let sign = (self.to - self.from).signum();
        let mut secs = self.pause_at(self.from, stops);
        for segment in self.segments(stops) {
            if sign * t <= sign * segment.to {
                let x = ((t - segment.from) / (segment.to - segment.from)).clamp(0.0, 1.0);
                return secs + segment.secs * segment.easing.inverse(x);
            }
            secs += segment.secs + segment.pause_secs;
        }
        // For t beyond the end of the pass, the result is the time at which the pass reaches its
        // end.
        secs - self.pause_at(self.to, stops)
    }

    /// Returns the easing of the segment that contains `t`. The stop at the segment's lower end may
    /// set it.
    #[must_use]
    pub fn easing_at(&self, t: f64, stops: &[TransitionStop]) -> EasingFunction {
        // If `t` is a stop, the segment is the one that begins there in the direction of the pass.
        let (begin, end) = self.segment(t, stops);
        self.segment_between(begin, end, stops).easing
    }

    /// Returns the average speed in the segment that contains `t`, in units of t per second.
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

    /// Returns the segment between two neighbouring stops, or ends of the pass, given by their t.
    fn segment_between(&self, from: f64, to: f64, stops: &[TransitionStop]) -> TimedSegment {
        // The stop at the lower end of a segment configures it, whichever way the pass runs.
        let low = from.min(to);
        let lower_stop = stops.iter().find(|stop| stop.t == low);
        let share = self.duration_secs * (to - from) / (self.to - self.from);
        TimedSegment {
            from,
            to,
            secs: lower_stop
                .and_then(|stop| stop.duration_secs)
                .unwrap_or(share),
            pause_secs: self.pause_at(to, stops),
            easing: lower_stop
                .and_then(|stop| stop.easing)
                .unwrap_or(self.easing),
        }
    }

    /// Returns the pause in seconds at `t`, if that is a stop or an end of the pass; otherwise 0.
    fn pause_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let stop_here = stops.iter().find(|stop| stop.t == t);
        let own = stop_here.map_or(0.0, |stop| stop.hold_secs);
        let is_end = t == self.from || t == self.to;
        own.max(if is_end { self.hold_secs } else { 0.0 })
    }

    /// Returns the t of the two neighbouring stops, or ends of the pass, between which `t` lies, in
    /// the order in which the pass reaches them. The two are never equal.
    fn segment(&self, t: f64, stops: &[TransitionStop]) -> (f64, f64) {
        // If the pass runs downwards, all t are negated, so that t always increases.
        let sign = (self.to - self.from).signum();
        let [from, to, t] = [self.from, self.to, t].map(|t| sign * t);
        let inside = stops.iter().map(|stop| sign * stop.t);
        let inside = inside.filter(|&s| from < s && s < to);
        // A stop belongs to the segment that begins there.
        let before = inside.clone().filter(|&s| s <= t).fold(from, f64::max);
        let after = inside.filter(|&s| s > t).fold(to, f64::min);
        (sign * before, sign * after)
    }
}

/// Segment of a pass; `from` and `to` are the values of t at its beginning and end, in the
/// direction of the pass.
#[derive(Clone, Copy, Debug)]
struct TimedSegment {
    from: f64,
    to: f64,
    /// Duration of the segment in seconds, without the pause.
    secs: f64,
    /// Pause in seconds at the end of the segment.
    pause_secs: f64,
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
        assert_eq!(timing.film_secs(&[]), 4.0);
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
        // In a pass from t = 1 to t = 0, the easing of a segment starts at its larger t, here at t
        // = 1.
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
            TransitionStop::at(1.0).with_pause(1.0),
            TransitionStop::at(0.0),
        ];
        let at = |secs, stops: &[TransitionStop]| timing.t_at(secs, stops);
        assert_eq!(timing.film_secs(&stops), 0.5 + 2.0 + 1.0 + 2.0 + 0.5);
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
        assert_eq!(timing.film_secs(&stops), 0.5 + 2.0 + 1.0 + 8.0 + 0.5);
        assert_eq!(at(7.5, &stops), 1.5);
        assert_eq!([0.5, 1.5].map(|t| timing.speed_at(t, &stops)), [0.5, 0.125]);
        let down = Timing {
            from: 2.0,
            to: 0.0,
            ..timing
        };
        assert_eq!(down.film_secs(&stops), timing.film_secs(&stops));
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
