//! When which t is shown: pure, and shared by the window and by export.
//!
//! A pass runs from one t to another and rests at both ends. Stops divide it
//! into segments that are eased one by one; time is shared out by length in
//! t. Playing once, in a loop or to and fro repeats passes.

use crate::easing::Ease;
use crate::names::named;
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
pub struct Stop {
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
    pub easing: Option<Ease>,
}

impl Stop {
    /// One without a name.
    #[must_use]
    pub fn at(t: f64) -> Self {
        Self {
            t,
            name: String::new(),
            note: String::new(),
            easing: None,
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
}

/// How a transition runs over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct Timing {
    /// Seconds of a pass, rests not counted; positive.
    pub duration_secs: f64,
    /// How t runs in each segment that no stop says more of.
    pub easing: Ease,
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
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            duration_secs: 4.0,
            easing: Ease::default(),
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
    pub fn check(&self, stops: &[Stop]) -> Result<(), TimingError> {
        if !(self.duration_secs.is_finite() && self.duration_secs > 0.0) {
            return Err(TimingError::Duration(self.duration_secs));
        }
        if !(self.hold_secs.is_finite() && self.hold_secs >= 0.0) {
            return Err(TimingError::Hold(self.hold_secs));
        }
        if !(self.from.is_finite() && self.to.is_finite()) || self.from == self.to {
            return Err(TimingError::Range(self.from, self.to));
        }
        match stops.iter().position(|stop| !stop.t.is_finite()) {
            Some(bad) => Err(TimingError::Stop(bad)),
            None => Ok(()),
        }
    }

    /// Seconds of one pass, rests included.
    #[must_use]
    pub fn pass_secs(&self) -> f64 {
        self.duration_secs + 2.0 * self.hold_secs
    }

    /// t after so many seconds of a pass; before and after it, its ends.
    ///
    /// ```
    /// use morphospace::transition::Timing;
    /// let timing = Timing::default();
    /// assert_eq!(timing.t_at(0.0, &[]), 0.0);
    /// assert_eq!(timing.t_at(timing.pass_secs(), &[]), 1.0);
    /// ```
    #[must_use]
    pub fn t_at(&self, secs: f64, stops: &[Stop]) -> f64 {
        let progress = ((secs - self.hold_secs) / self.duration_secs).clamp(0.0, 1.0);
        let even = self.from + (self.to - self.from) * progress;
        let (begin, end) = self.segment(even, stops);
        if progress >= 1.0 {
            return self.to; // to the last bit
        }
        let x = (even - begin) / (end - begin);
        begin + (end - begin) * self.easing_at(even, stops).apply(x.clamp(0.0, 1.0))
    }

    /// The seconds after which a pass is at `t`; the inverse of
    /// [`Self::t_at`], with the moment of departure for the beginning and of
    /// arrival for the end.
    #[must_use]
    pub fn secs_at(&self, t: f64, stops: &[Stop]) -> f64 {
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let t = t.clamp(low, high);
        let (begin, end) = self.segment(t, stops);
        let x = self
            .easing_at(t, stops)
            .inverse((t - begin) / (end - begin));
        let even = begin + (end - begin) * x;
        self.hold_secs + self.duration_secs * (even - self.from) / (self.to - self.from)
    }

    /// How t runs in the segment that `t` lies in: as the stop at its lower end
    /// says, if it says anything.
    #[must_use]
    pub fn easing_at(&self, t: f64, stops: &[Stop]) -> Ease {
        // On a stop the segment that begins there in the direction of the pass.
        let (begin, end) = self.segment(t, stops);
        let low = begin.min(end);
        let there = stops.iter().find(|stop| stop.t == low);
        there.and_then(|stop| stop.easing).unwrap_or(self.easing)
    }

    /// The two neighbouring stops or ends between which `t` lies, in the
    /// direction of the pass; never equal.
    fn segment(&self, t: f64, stops: &[Stop]) -> (f64, f64) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::easing::{Curve, Easing};
    use proptest::prelude::*;

    fn stops(at: &[f64]) -> Vec<Stop> {
        at.iter().copied().map(Stop::at).collect()
    }

    #[test]
    fn a_pass_rests_departs_arrives_and_rests() {
        let timing = Timing {
            duration_secs: 2.0,
            hold_secs: 1.0,
            easing: Easing::Linear.into(),
            ..Timing::default()
        };
        let at = |secs| timing.t_at(secs, &[]);
        assert_eq!([at(-1.0), at(0.0), at(1.0)], [0.0; 3]);
        assert_eq!(at(2.0), 0.5);
        assert_eq!([at(3.0), at(4.0), at(99.0)], [1.0; 3]);
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
        let curve = Curve::new([0.9, 0.0, 1.0, 0.2]).expect("a curve");
        stops[0].easing = Some(Ease::Drawn(curve));
        let timing = Timing {
            duration_secs: 1.0,
            hold_secs: 0.0,
            easing: Easing::Linear.into(),
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
            (from, to) in prop_oneof![Just((0.0, 1.0)), Just((1.0, 0.0)), Just((-0.4, 1.3))],
        ) {
            let timing = Timing {
                duration_secs: 4.0, hold_secs: 0.0, easing: Easing::ALL[easing].into(),
                from, to, ..Timing::default()
            };
            let stops = stops(&at);
            let t = timing.t_at(secs, &stops);
            prop_assert!((timing.t_at(timing.secs_at(t, &stops), &stops) - t).abs() < 1e-9);
            let later = timing.t_at(secs + more, &stops);
            prop_assert!((later - t) * (to - from) >= 0.0);
        }
    }
}
