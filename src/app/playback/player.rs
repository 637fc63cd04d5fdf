//! Playback: moves the blend parameter t over time, and from stop to stop as from slide to slide.
//!
//! [`Playback`] is a plain value whose actions are methods, so that tests can call them. The film
//! runs on [`Timing`], which the export shares. Playing to a stop uses a separate motion: it starts
//! at the current t, eases like the film, ignores pauses, and so also reaches stops outside the
//! film's range.

use bevy::prelude::{MessageReader, Res, ResMut, Resource, Time};

use crate::app::input::intent::Intent;
use crate::app::session::state::Session;
use crate::transition::{EasingFunction, PlayMode, Timing, TransitionStop};

/// Difference in t below which two stops are the same (tolerance: the finest step on screen is
/// 0.001).
pub const STOP_TOLERANCE_T: f64 = 1e-6;

/// Distance in t from a design within which two films of the same designs look the same
/// (heuristic).
const SWAP_DISTANCE_T: f64 = 0.03;

/// Playback speeds that `[` and `]` step through, as factors (heuristic).
pub const SPEEDS: [f64; 10] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0];

/// Motion of t.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PlaybackMotion {
    Still,
    /// Plays the film; `secs` is the current position, in seconds from its start.
    Film {
        secs: f64,
    },
    /// Plays to a stop.
    ToStop(SegmentToStop),
}

/// Motion from one t to that of a stop, eased over `secs` seconds, of which `elapsed` have passed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SegmentToStop {
    from: f64,
    to: f64,
    elapsed: f64,
    secs: f64,
    easing: EasingFunction,
}

/// Current t and its motion.
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
    /// The blend parameter: 0 at the first design, 1 at the second and so on. Before the first
    /// design and after the last one the blend extrapolates.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// Whether t is moving.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.motion != PlaybackMotion::Still
    }

    /// Whether another film of the same designs may now replace this one, as when the best film
    /// replaces a draft. True while t is at rest, so that no motion jumps, and while t is near a
    /// whole number that is not negative. A film that neither starts nor ends at such a t may be
    /// replaced at any time.
    #[must_use]
    pub fn can_swap_film(&self, timing: &Timing) -> bool {
        // At a whole t within the film all films show the same design, so a draft and the film that
        // replaces it look the same there. Before the first design they extrapolate differently.
        let is_end = |t: f64| t > -SWAP_DISTANCE_T && (t - t.round()).abs() < SWAP_DISTANCE_T;
        let meets_an_end = [timing.from, timing.to].into_iter().any(is_end);
        !self.is_playing() || is_end(self.t) || !meets_an_end
    }

    /// Whether the film plays, or would play, backwards.
    #[must_use]
    pub fn is_backwards(&self) -> bool {
        self.backwards
    }

    /// Playback speed; 1 is the speed that the project's timing gives.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Moves t to the start of the film, stops there and resets the direction; keeps the speed.
    pub fn rewind(&mut self, timing: &Timing) {
        self.motion = PlaybackMotion::Still;
        self.backwards = false;
        self.t = timing.from;
    }

    /// Sets t. A running film continues from there; a motion to a stop ends. Ignores non-finite
    /// values.
    pub fn seek(&mut self, t: f64, timing: &Timing, stops: &[TransitionStop]) {
        if !t.is_finite() {
            return;
        }
        self.t = t;
        self.motion = match self.motion {
            PlaybackMotion::Film { .. } => PlaybackMotion::Film {
                secs: timing.secs_at(t, stops),
            },
            PlaybackMotion::Still | PlaybackMotion::ToStop(_) => PlaybackMotion::Still,
        };
    }

    /// Stops playback and moves t by a number of hundredths. Rounding errors do not add up: if t
    /// was a whole number of hundredths, it remains one.
    pub fn step(&mut self, hundredths: i32) {
        self.motion = PlaybackMotion::Still;
        let t = self.t + f64::from(hundredths) / 100.0;
        // Rounded, because hundredths are no binary fractions: ten steps would miss a tenth.
        self.t = (t * 1e9).round() / 1e9;
    }

    /// Plays or pauses. A film at its end starts again.
    pub fn toggle(&mut self, timing: &Timing, stops: &[TransitionStop]) {
        if self.is_playing() {
            self.motion = PlaybackMotion::Still;
            return;
        }
        let film_secs = timing.film_secs(stops);
        let secs = timing.secs_at(self.t, stops);
        // In the direction of playback: the start of the film in seconds, and the end of the film
        // as a value of t.
        let (start, end) = if self.backwards {
            (film_secs, timing.from)
        } else {
            (0.0, timing.to)
        };
        let is_at_end = (self.t - end).abs() < STOP_TOLERANCE_T;
        // Ping-pong has no end: the film turns round by itself.
        let secs = if is_at_end && timing.play != PlayMode::PingPong {
            start
        } else {
            secs
        };
        self.motion = PlaybackMotion::Film { secs };
    }

    /// Reverses the direction of playback; a motion to a stop turns back to its start.
    pub fn reverse(&mut self) {
        self.backwards = !self.backwards;
        if let PlaybackMotion::ToStop(motion) = &mut self.motion {
            // The reversed motion continues at the elapsed time for which its easing gives the
            // current t.
            let progress = if motion.secs > 0.0 {
                motion.easing.apply(motion.elapsed / motion.secs)
            } else {
                1.0
            };
            *motion = SegmentToStop {
                from: motion.to,
                to: motion.from,
                elapsed: motion.secs * motion.easing.inverse(1.0 - progress),
                ..*motion
            };
        }
    }

    /// Plays from the current t to `to` and stops there.
    pub fn play_to(&mut self, to: f64, timing: &Timing, stops: &[TransitionStop]) {
        // The motion takes about as long as the film takes for the same distance in t.
        let middle = 0.5 * (self.t + to);
        let secs = (to - self.t).abs() / timing.speed_at(middle, stops);
        self.motion = PlaybackMotion::ToStop(SegmentToStop {
            from: self.t,
            to,
            elapsed: 0.0,
            secs,
            easing: timing.easing_at(middle, stops),
        });
    }

    /// The t from which the next stop is counted: the current t, or the stop to which t is already
    /// moving.
    fn heading(&self) -> f64 {
        match self.motion {
            // During a motion to a stop, the next stop is counted from that stop, not from the
            // current t. Each further key press therefore leads one stop further.
            PlaybackMotion::ToStop(motion) => motion.to,
            PlaybackMotion::Still | PlaybackMotion::Film { .. } => self.t,
        }
    }

    /// Value of t at the next stop or end of the film; `None` after the last of these.
    #[must_use]
    pub fn next_stop(&self, timing: &Timing, stops: &[TransitionStop]) -> Option<f64> {
        next_landmark(self.heading(), false, timing, stops)
    }

    /// Selects the next higher speed of `SPEEDS` or, if not `faster`, the next lower one.
    pub fn change_speed(&mut self, faster: bool) {
        let next = if faster {
            // A speed between two entries moves to the next entry.
            SPEEDS.iter().find(|speed| **speed > self.speed)
        } else {
            SPEEDS.iter().rev().find(|speed| **speed < self.speed)
        };
        self.speed = next.copied().unwrap_or(self.speed);
    }

    /// Sets the speed, clamped to the range of `SPEEDS`; ignores non-finite values.
    pub fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.clamp(SPEEDS[0], SPEEDS[SPEEDS.len() - 1]);
        }
    }

    /// Advances playback by `dt_secs` seconds of real time.
    pub fn advance(&mut self, dt_secs: f64, timing: &Timing, stops: &[TransitionStop]) {
        let step = dt_secs * self.speed;
        match self.motion {
            PlaybackMotion::Still => {}
            PlaybackMotion::ToStop(motion) => {
                let elapsed = motion.elapsed + step;
                self.advance_to_stop(SegmentToStop { elapsed, ..motion });
            }
            PlaybackMotion::Film { secs } => {
                let signed_step = if self.backwards { -step } else { step };
                self.advance_film(secs + signed_step, timing, stops);
            }
        }
    }

    fn advance_to_stop(&mut self, motion: SegmentToStop) {
        // Also true for a motion that takes no time, so that the division below is safe.
        if motion.elapsed >= motion.secs {
            self.t = motion.to;
            self.motion = PlaybackMotion::Still;
            return;
        }
        let progress = motion.easing.apply(motion.elapsed / motion.secs);
        self.t = motion.from + (motion.to - motion.from) * progress;
        self.motion = PlaybackMotion::ToStop(motion);
    }

    /// Moves to the position `unclamped_secs` in the film, in seconds from the film's start. Beyond
    /// its start or end, the film stops, repeats or turns round, depending on the play mode.
    fn advance_film(&mut self, unclamped_secs: f64, timing: &Timing, stops: &[TransitionStop]) {
        let film_secs = timing.film_secs(stops);
        let is_past_end = if self.backwards {
            unclamped_secs <= 0.0
        } else {
            unclamped_secs >= film_secs
        };
        let secs = match timing.play {
            // A film without duration ends at once; dividing by its duration is avoided.
            _ if film_secs <= 0.0 => 0.0,
            PlayMode::Once => unclamped_secs.clamp(0.0, film_secs),
            PlayMode::Loop => unclamped_secs.rem_euclid(film_secs),
            PlayMode::PingPong => {
                // At tenfold speed, the film may turn round several times between two slow screen
                // updates.
                let turns = (unclamped_secs / film_secs).floor();
                let secs_from_end = unclamped_secs - turns * film_secs;
                if turns.rem_euclid(2.0) == 0.0 {
                    secs_from_end
                } else {
                    self.backwards = !self.backwards;
                    film_secs - secs_from_end
                }
            }
        };
        self.t = timing.t_at(secs, stops);
        let ends = film_secs <= 0.0 || (is_past_end && timing.play == PlayMode::Once);
        self.motion = if ends {
            PlaybackMotion::Still
        } else {
            PlaybackMotion::Film { secs }
        };
    }
}

/// Values of t, in ascending order, between which the keys for stops move: all stops, and the start
/// and end of the film.
#[must_use]
pub fn landmarks(timing: &Timing, stops: &[TransitionStop]) -> Vec<f64> {
    let mut all: Vec<f64> = stops.iter().map(|stop| stop.t).collect();
    all.extend([timing.from, timing.to]);
    all.sort_by(f64::total_cmp);
    // Sorted above, so duplicates are adjacent.
    all.dedup_by(|a, b| (*a - *b).abs() < STOP_TOLERANCE_T);
    all
}

/// Value of t at which a talk starts: the first stop in the film's direction, or the film's start
/// if there are no stops.
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

/// The first of the [`landmarks`] after `t` in the film's direction or, if `backwards`, the last
/// one before `t`; `None` if there is none.
#[must_use]
pub fn next_landmark(
    t: f64,
    backwards: bool,
    timing: &Timing,
    stops: &[TransitionStop],
) -> Option<f64> {
    let all = landmarks(timing, stops);
    // A film may run from a larger t to a smaller one.
    if backwards != (timing.to < timing.from) {
        all.into_iter()
            .rev()
            .find(|place| *place < t - STOP_TOLERANCE_T)
    } else {
        all.into_iter().find(|place| *place > t + STOP_TOLERANCE_T)
    }
}

/// Applies the intents that control playback.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut playback: ResMut<Playback>,
    session: Res<Session>,
) {
    let (timing, stops) = (session.timing(), session.stops());
    for intent in intents.read() {
        playback.apply_intent(intent, timing, stops);
    }
}

impl Playback {
    /// Applies one intent; ignores intents that do not control playback.
    pub fn apply_intent(&mut self, intent: &Intent, timing: &Timing, stops: &[TransitionStop]) {
        match intent {
            Intent::TogglePlay => self.toggle(timing, stops),
            Intent::Reverse => self.reverse(),
            Intent::Step(hundredths) => self.step(*hundredths),
            Intent::Seek(t) => self.seek(*t, timing, stops),
            Intent::SeekStart => self.seek(timing.from, timing, stops),
            Intent::SeekEnd => self.seek(timing.to, timing, stops),
            Intent::JumpToNextStop => self.jump_to_neighbour(false, timing, stops),
            Intent::JumpToPreviousStop => self.jump_to_neighbour(true, timing, stops),
            Intent::PlayToNextStop => self.play_to_neighbour(false, timing, stops),
            Intent::PlayToPreviousStop => self.play_to_neighbour(true, timing, stops),
            Intent::Faster => self.change_speed(true),
            Intent::Slower => self.change_speed(false),
            Intent::NormalSpeed => self.set_speed(1.0),
            Intent::SetSpeed(speed) => self.set_speed(*speed),
            _ => {}
        }
    }

    /// Jumps to the next stop or, if `backwards`, to the previous one.
    fn jump_to_neighbour(&mut self, backwards: bool, timing: &Timing, stops: &[TransitionStop]) {
        if let Some(t) = next_landmark(self.t, backwards, timing, stops) {
            self.motion = PlaybackMotion::Still;
            self.t = t;
        }
    }

    /// Plays to the next stop or, if `backwards`, to the previous one.
    fn play_to_neighbour(&mut self, backwards: bool, timing: &Timing, stops: &[TransitionStop]) {
        if let Some(t) = next_landmark(self.heading(), backwards, timing, stops) {
            self.play_to(t, timing, stops);
        }
    }
}

/// Advances playback by the time since the last screen update.
pub fn advance(time: Res<Time>, mut playback: ResMut<Playback>, session: Res<Session>) {
    if playback.is_playing() {
        playback.advance(time.delta_secs_f64(), session.timing(), session.stops());
    }
}

#[cfg(test)]
mod tests;
