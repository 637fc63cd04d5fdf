//! When which t is shown: pure, and shared by the window and by export.
//!
//! A pass runs from one t to another and rests at both ends. Stops divide it
//! into segments that are eased one by one, and may be rested at; time is shared out
//! by length in t, but for segments that have a time of their own. Playing once, in a
//! loop or to and fro repeats passes.

use crate::settings::choice::named;
use crate::time::easing::EasingFunction;
use serde::{Deserialize, Serialize};

/// What happens at the end of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlayMode {
    /// Playing stops.
    Once,
    /// The pass begins again.
    Loop,
    /// The pass is run backwards, and so on.
    #[default]
    PingPong,
}

named! { PlayMode {
    PingPong: "ping-pong", "Ping-pong", "There and back, again and again";
    Loop: "loop", "Loop", "Starts again at the end";
    Once: "once", "Once", "Stops at the end";
} }

/// A named place in the transition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransitionStop {
    /// Where it is.
    pub t: f64,
    /// What it is called; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What a speaker says there; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// How t runs from here up to the next stop; none is as everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub easing: Option<EasingFunction>,
    /// Seconds from here up to the next stop, positive; none is the share of the pass
    /// that its length in t has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_secs: Option<f64>,
    /// Seconds of rest here, not negative; at the ends of a pass at least as long as
    /// there.
    #[serde(default, skip_serializing_if = "is_none")]
    pub hold_secs: f64,
}

fn is_none(secs: &f64) -> bool {
    *secs == 0.0
}

impl TransitionStop {
    /// One without a name.
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

    /// The same with a name.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// The same with a rest of so many seconds.
    #[must_use]
    pub fn resting(self, hold_secs: f64) -> Self {
        Self { hold_secs, ..self }
    }
}

/// How a transition runs over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct Timing {
    /// Seconds of a pass, rests not counted; positive. Segments with a time of their own
    /// take that instead of their share of it.
    pub duration_secs: f64,
    /// How t runs in each segment that no stop says more of.
    pub easing: EasingFunction,
    /// Seconds of rest at each end; not negative.
    pub hold_secs: f64,
    /// What happens at the end of a pass.
    pub play: PlayMode,
    /// t at the beginning.
    pub from: f64,
    /// t at the end; differs from the beginning.
    pub to: f64,
}

/// Numbers that give no pass.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TimingError {
    /// The duration is not positive.
    #[error("a pass cannot last {0} seconds; give a positive duration")]
    Duration(f64),
    /// The rest is negative.
    #[error("a rest cannot last {0} seconds; give 0 or more")]
    Hold(f64),
    /// The ends are equal or not finite.
    #[error("a pass cannot run from t = {0} to t = {1}; give two different finite numbers")]
    Range(f64, f64),
    /// A stop is not finite.
    #[error("stop {} is at no finite t; correct or remove it", .0 + 1)]
    Stop(usize),
    /// A stop rests for a negative time, or the way from it takes none.
    #[error("stop {} has a time that is none: give a positive duration and a rest of 0 or more", .0 + 1)]
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
    /// Checks that there is a pass to run.
    ///
    /// # Errors
    /// [`TimingError`] names the number that is wrong.
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
        if let Some(bad) = stops.iter().position(|stop| !stop.t.is_finite()) {
            return Err(TimingError::Stop(bad));
        }
        let is_rest = |secs: f64| secs.is_finite() && secs >= 0.0;
        let is_way = |secs: f64| secs.is_finite() && secs > 0.0;
        let is_sound = |stop: &TransitionStop| {
            is_rest(stop.hold_secs) && stop.duration_secs.is_none_or(is_way)
        };
        match stops.iter().position(|stop| !is_sound(stop)) {
            Some(bad) => Err(TimingError::StopSecs(bad)),
            None => Ok(()),
        }
    }

    /// Seconds of one pass, rests included.
    #[must_use]
    pub fn pass_secs(&self, stops: &[TransitionStop]) -> f64 {
        let ways = self.segments(stops).map(|way| way.secs + way.rest);
        self.rest_at(self.from, stops) + ways.sum::<f64>()
    }

    /// t after so many seconds of a pass; before and after it, its ends.
    ///
    /// ```
    /// use morphospace::transition::Timing;
    /// let timing = Timing::default();
    /// assert_eq!(timing.t_at(0.0, &[]), 0.0);
    /// assert_eq!(timing.t_at(timing.pass_secs(&[]), &[]), 1.0);
    /// ```
    #[must_use]
    pub fn t_at(&self, secs: f64, stops: &[TransitionStop]) -> f64 {
        let mut left = secs - self.rest_at(self.from, stops);
        if left <= 0.0 {
            return self.from; // to the last bit, as all that rests
        }
        for way in self.segments(stops) {
            if left < way.secs {
                let x = way.easing.apply((left / way.secs).clamp(0.0, 1.0));
                return way.from + (way.to - way.from) * x;
            }
            left -= way.secs + way.rest;
            if left < 0.0 {
                return way.to;
            }
        }
        self.to
    }

    /// The seconds after which a pass is at `t`; the inverse of
    /// [`Self::t_at`], where it rests with the moment of arrival, and of departure
    /// for the beginning.
    #[must_use]
    pub fn secs_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let sign = (self.to - self.from).signum();
        let mut secs = self.rest_at(self.from, stops);
        for way in self.segments(stops) {
            if sign * t <= sign * way.to {
                let x = ((t - way.from) / (way.to - way.from)).clamp(0.0, 1.0);
                return secs + way.secs * way.easing.inverse(x);
            }
            secs += way.secs + way.rest;
        }
        // Beyond the end: as it arrives there.
        secs - self.rest_at(self.to, stops)
    }

    /// How t runs in the segment that `t` lies in: as the stop at its lower end
    /// says, if it says anything.
    #[must_use]
    pub fn easing_at(&self, t: f64, stops: &[TransitionStop]) -> EasingFunction {
        // On a stop the segment that begins there in the direction of the pass.
        let (begin, end) = self.segment(t, stops);
        self.said(begin, end, stops).easing
    }

    /// How many units of t a pass makes in a second, on average, where `t` is.
    #[must_use]
    pub fn speed_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let (begin, end) = self.segment(t, stops);
        (end - begin).abs() / self.said(begin, end, stops).secs
    }

    /// The segments of a pass, one after the other.
    fn segments<'a>(
        &'a self,
        stops: &'a [TransitionStop],
    ) -> impl Iterator<Item = TimedSegment> + 'a {
        let mut at = Some(self.from);
        std::iter::from_fn(move || {
            let from = at?;
            let (begin, end) = self.segment(from, stops);
            at = (end != self.to).then_some(end);
            Some(self.said(begin, end, stops))
        })
    }

    /// What is said of the segment between two neighbours.
    fn said(&self, from: f64, to: f64, stops: &[TransitionStop]) -> TimedSegment {
        // Backwards it runs as it was drawn, from where it begins then.
        let low = from.min(to);
        let there = stops.iter().find(|stop| stop.t == low);
        let share = self.duration_secs * (to - from) / (self.to - self.from);
        TimedSegment {
            from,
            to,
            secs: there.and_then(|stop| stop.duration_secs).unwrap_or(share),
            rest: self.rest_at(to, stops),
            easing: there.and_then(|stop| stop.easing).unwrap_or(self.easing),
        }
    }

    /// How long a pass rests at a stop or an end.
    fn rest_at(&self, t: f64, stops: &[TransitionStop]) -> f64 {
        let there = stops.iter().find(|stop| stop.t == t);
        let own = there.map_or(0.0, |stop| stop.hold_secs);
        let is_end = t == self.from || t == self.to;
        own.max(if is_end { self.hold_secs } else { 0.0 })
    }

    /// The two neighbouring stops or ends between which `t` lies, in the
    /// direction of the pass; never equal.
    fn segment(&self, t: f64, stops: &[TransitionStop]) -> (f64, f64) {
        // With its sign exchanged where the pass runs down, t always rises.
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

/// A segment of a pass, in its direction.
#[derive(Clone, Copy, Debug)]
struct TimedSegment {
    from: f64,
    to: f64,
    /// How long it takes.
    secs: f64,
    /// How long is rested at its end.
    rest: f64,
    easing: EasingFunction,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::easing::{EasingBezier, NamedEasing};
    use proptest::prelude::*;

    fn stops(at: &[f64]) -> Vec<TransitionStop> {
        at.iter().copied().map(TransitionStop::at).collect()
    }

    #[test]
    fn a_pass_rests_departs_arrives_and_rests() {
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
    fn each_segment_is_eased_alone() {
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
    fn a_stop_says_how_t_runs_from_it_up() {
        let mut stops = stops(&[0.5]);
        let curve = EasingBezier::new([0.9, 0.0, 1.0, 0.2]).expect("a curve");
        stops[0].easing = Some(EasingFunction::Drawn(curve));
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
        // Backwards it runs as it was drawn, from where it begins then.
        assert!(down.t_at(0.25, &stops) > 0.9);
        assert_eq!(down.t_at(0.75, &stops), 0.25);
    }

    #[test]
    fn a_stop_may_be_rested_at_and_have_a_time_of_its_own() {
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
    fn impossible_numbers_are_named() {
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
