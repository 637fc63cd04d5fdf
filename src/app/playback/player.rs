//! Time in the window: playing, stepping, stops as slides.
//!
//! [`Playback`] is a plain value: every act on it is a method that a test can call. A pass runs on
//! [`Timing`], which the export shares. Playing to a stop runs on a leg of its own, which starts
//! from where t is, eases as the timing says, knows no holds, and so reaches stops outside the
//! pass too.

use bevy::prelude::{MessageReader, Res, ResMut, Resource, Time};

use crate::app::input::intent::Intent;
use crate::app::session::state::Session;
use crate::transition::{EasingFunction, PlayMode, Timing, TransitionStop};

/// Two stops nearer than this are one; the finest step on screen is a thousandth.
pub const SAME_T: f64 = 1e-6;

/// So near to an end two films of the same designs look the same: the steps of a slow film.
const SAME_FILM: f64 = 0.03;

/// The speeds that `[` and `]` go through, as factors of the timing's.
pub const SPEEDS: [f64; 10] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0];

/// How t moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PlaybackMotion {
    Still,
    /// Along the pass, at this second of it.
    Pass {
        secs: f64,
    },
    Leg(SegmentToStop),
}

/// The way to a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SegmentToStop {
    from: f64,
    to: f64,
    elapsed: f64,
    secs: f64,
    easing: EasingFunction,
}

/// Where t is and how it moves.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Playback {
    t: f64,
    motion: PlaybackMotion,
    backwards: bool,
    speed: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            t: 0.0,
            motion: PlaybackMotion::Still,
            backwards: false,
            speed: 1.0,
        }
    }
}

impl Playback {
    /// The blend parameter; outside 0..1 it extrapolates.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// t is moving.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.motion != PlaybackMotion::Still
    }

    /// Another film of the same designs can take this one's place without being seen to: at rest,
    /// and where all films are the same. Where the pass never comes there, any time is as good.
    #[must_use]
    pub fn may_change_film(&self, timing: &Timing) -> bool {
        // All films of a leg are the same at the designs.
        let is_end = |t: f64| t < SAME_FILM || (t - t.round()).abs() < SAME_FILM;
        let meets_an_end = [timing.from, timing.to].into_iter().any(is_end);
        !self.is_playing() || is_end(self.t) || !meets_an_end
    }

    /// A pass runs, or would run, from its end to its start.
    #[must_use]
    pub fn is_backwards(&self) -> bool {
        self.backwards
    }

    /// The factor on the timing's speed.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Goes to where a pass starts and stays there; the speed stays too.
    pub fn begin(&mut self, timing: &Timing) {
        self.motion = PlaybackMotion::Still;
        self.backwards = false;
        self.t = timing.from;
    }

    /// Sets t. A running pass goes on from there, a leg to a stop ends. Not a number is ignored.
    pub fn seek(&mut self, t: f64, timing: &Timing, stops: &[TransitionStop]) {
        if !t.is_finite() {
            return;
        }
        self.t = t;
        self.motion = match self.motion {
            PlaybackMotion::Pass { .. } => PlaybackMotion::Pass {
                secs: timing.secs_at(t, stops),
            },
            PlaybackMotion::Still | PlaybackMotion::Leg(_) => PlaybackMotion::Still,
        };
    }

    /// Moves t by so many hundredths and stops there, on a whole hundredth where t was on one.
    pub fn step(&mut self, hundredths: i32) {
        self.motion = PlaybackMotion::Still;
        let t = self.t + f64::from(hundredths) / 100.0;
        // Hundredths are no sums of powers of two: ten steps of them would end beside a tenth.
        self.t = (t * 1e9).round() / 1e9;
    }

    /// Plays, or pauses. At its end a pass starts again.
    pub fn toggle(&mut self, timing: &Timing, stops: &[TransitionStop]) {
        if self.is_playing() {
            self.motion = PlaybackMotion::Still;
            return;
        }
        let pass = timing.pass_secs(stops);
        let secs = timing.secs_at(self.t, stops);
        let (start, end) = if self.backwards {
            (pass, timing.from)
        } else {
            (0.0, timing.to)
        };
        let at_end = (self.t - end).abs() < SAME_T;
        // To and fro there is no end: the pass turns round there by itself.
        let secs = if at_end && timing.play != PlayMode::PingPong {
            start
        } else {
            secs
        };
        self.motion = PlaybackMotion::Pass { secs };
    }

    /// Plays the other way; a leg to a stop turns back to where it came from.
    pub fn reverse(&mut self) {
        self.backwards = !self.backwards;
        if let PlaybackMotion::Leg(leg) = &mut self.motion {
            // Where the way back is as far along as the way there, eased as it is.
            let there = if leg.secs > 0.0 {
                leg.easing.apply(leg.elapsed / leg.secs)
            } else {
                1.0
            };
            *leg = SegmentToStop {
                from: leg.to,
                to: leg.from,
                elapsed: leg.secs * leg.easing.inverse(1.0 - there),
                ..*leg
            };
        }
    }

    /// Plays to `to` and waits there; `backwards` is how a pass would go on from it.
    pub fn play_to(&mut self, to: f64, timing: &Timing, stops: &[TransitionStop]) {
        // As fast as a pass runs over the same way.
        let middle = 0.5 * (self.t + to);
        let secs = (to - self.t).abs() / timing.speed_at(middle, stops);
        self.motion = PlaybackMotion::Leg(SegmentToStop {
            from: self.t,
            to,
            elapsed: 0.0,
            secs,
            easing: timing.easing_at(middle, stops),
        });
    }

    /// The stop that slides go to from here: that after the one which t is already on its way to.
    fn heading(&self) -> f64 {
        match self.motion {
            // Pressed twice in a row, the second time means the stop after the next.
            PlaybackMotion::Leg(leg) => leg.to,
            PlaybackMotion::Still | PlaybackMotion::Pass { .. } => self.t,
        }
    }

    /// Where slides go to from here; none beyond the last.
    #[must_use]
    pub fn next_stop(&self, timing: &Timing, stops: &[TransitionStop]) -> Option<f64> {
        next_landmark(self.heading(), false, timing, stops)
    }

    /// The next faster (or slower) speed of the fixed list.
    pub fn change_speed(&mut self, faster: bool) {
        let next = if faster {
            // From a speed between two of the list, as it may be set, to the next of them.
            SPEEDS.iter().find(|speed| **speed > self.speed)
        } else {
            SPEEDS.iter().rev().find(|speed| **speed < self.speed)
        };
        self.speed = next.copied().unwrap_or(self.speed);
    }

    /// This speed, kept within those of the fixed list; not a number is ignored.
    pub fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.clamp(SPEEDS[0], SPEEDS[SPEEDS.len() - 1]);
        }
    }

    /// Moves t by `dt_secs` of the clock on the wall.
    pub fn advance(&mut self, dt_secs: f64, timing: &Timing, stops: &[TransitionStop]) {
        let step = dt_secs * self.speed;
        match self.motion {
            PlaybackMotion::Still => {}
            PlaybackMotion::Leg(leg) => {
                let elapsed = leg.elapsed + step;
                self.advance_leg(SegmentToStop { elapsed, ..leg });
            }
            PlaybackMotion::Pass { secs } => {
                let signed = if self.backwards { -step } else { step };
                self.advance_pass(secs + signed, timing, stops);
            }
        }
    }

    fn advance_leg(&mut self, leg: SegmentToStop) {
        // Also where a leg takes no time: what is divided by below is above 0.
        if leg.elapsed >= leg.secs {
            self.t = leg.to;
            self.motion = PlaybackMotion::Still;
            return;
        }
        self.t = leg.from + (leg.to - leg.from) * leg.easing.apply(leg.elapsed / leg.secs);
        self.motion = PlaybackMotion::Leg(leg);
    }

    fn advance_pass(&mut self, raw: f64, timing: &Timing, stops: &[TransitionStop]) {
        let pass = timing.pass_secs(stops);
        let over = if self.backwards {
            raw <= 0.0
        } else {
            raw >= pass
        };
        let secs = match timing.play {
            // A pass that takes no time is over at once, and nothing can be divided by it.
            _ if pass <= 0.0 => 0.0,
            PlayMode::Once => raw.clamp(0.0, pass),
            PlayMode::Loop => raw.rem_euclid(pass),
            PlayMode::PingPong => {
                // A slow frame at ten times the speed may run past more than one end.
                let turns = (raw / pass).floor();
                let along = raw - turns * pass;
                if turns.rem_euclid(2.0) == 0.0 {
                    along
                } else {
                    self.backwards = !self.backwards;
                    pass - along
                }
            }
        };
        self.t = timing.t_at(secs, stops);
        let ends = pass <= 0.0 || (over && timing.play == PlayMode::Once);
        self.motion = if ends {
            PlaybackMotion::Still
        } else {
            PlaybackMotion::Pass { secs }
        };
    }
}

/// The places that ↑ ↓ and the slides go to: the stops and the two ends of the pass, in order.
#[must_use]
pub fn landmarks(timing: &Timing, stops: &[TransitionStop]) -> Vec<f64> {
    let mut all: Vec<f64> = stops.iter().map(|stop| stop.t).collect();
    all.extend([timing.from, timing.to]);
    all.sort_by(f64::total_cmp);
    // Sorted before, so that those that are one lie side by side.
    all.dedup_by(|a, b| (*a - *b).abs() < SAME_T);
    all
}

/// Where a talk begins: the first stop in the direction of the pass; the start of the pass where
/// there is none.
#[must_use]
pub fn first_stop(timing: &Timing, stops: &[TransitionStop]) -> f64 {
    let along = |stop: &TransitionStop| {
        if timing.to < timing.from {
            -stop.t
        } else {
            stop.t
        }
    };
    let first = stops.iter().min_by(|a, b| along(a).total_cmp(&along(b)));
    first.map_or(timing.from, |stop| stop.t)
}

/// The first landmark after `t` in the direction of the pass, or the last before it.
#[must_use]
pub fn next_landmark(
    t: f64,
    backwards: bool,
    timing: &Timing,
    stops: &[TransitionStop],
) -> Option<f64> {
    let all = landmarks(timing, stops);
    // A pass may run from a larger t to a smaller one: on is then down.
    if backwards != (timing.to < timing.from) {
        all.into_iter().rev().find(|place| *place < t - SAME_T)
    } else {
        all.into_iter().find(|place| *place > t + SAME_T)
    }
}

/// Acts on the intents that concern time.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut playback: ResMut<Playback>,
    session: Res<Session>,
) {
    let (timing, stops) = (session.timing(), session.stops());
    for intent in intents.read() {
        playback.act(intent, timing, stops);
    }
}

impl Playback {
    /// Acts on one intent; ignores those that do not concern time.
    pub fn act(&mut self, intent: &Intent, timing: &Timing, stops: &[TransitionStop]) {
        match intent {
            Intent::TogglePlay => self.toggle(timing, stops),
            Intent::Reverse => self.reverse(),
            Intent::Step(hundredths) => self.step(*hundredths),
            Intent::Seek(t) => self.seek(*t, timing, stops),
            Intent::SeekStart => self.seek(timing.from, timing, stops),
            Intent::SeekEnd => self.seek(timing.to, timing, stops),
            Intent::JumpToNextStop => self.jump(false, timing, stops),
            Intent::JumpToPreviousStop => self.jump(true, timing, stops),
            Intent::PlayToNextStop => self.slide(false, timing, stops),
            Intent::PlayToPreviousStop => self.slide(true, timing, stops),
            Intent::Faster => self.change_speed(true),
            Intent::Slower => self.change_speed(false),
            Intent::NormalSpeed => self.set_speed(1.0),
            Intent::Speed(speed) => self.set_speed(*speed),
            _ => {}
        }
    }

    fn jump(&mut self, backwards: bool, timing: &Timing, stops: &[TransitionStop]) {
        if let Some(t) = next_landmark(self.t, backwards, timing, stops) {
            self.motion = PlaybackMotion::Still;
            self.t = t;
        }
    }

    fn slide(&mut self, backwards: bool, timing: &Timing, stops: &[TransitionStop]) {
        if let Some(t) = next_landmark(self.heading(), backwards, timing, stops) {
            self.play_to(t, timing, stops);
        }
    }
}

/// Lets t move with the clock.
pub fn advance(time: Res<Time>, mut playback: ResMut<Playback>, session: Res<Session>) {
    if playback.is_playing() {
        playback.advance(time.delta_secs_f64(), session.timing(), session.stops());
    }
}

#[cfg(test)]
mod tests;
