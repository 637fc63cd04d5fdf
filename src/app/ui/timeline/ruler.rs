//! Mapping between t and horizontal positions on the track of the timeline.

use bevy_egui::egui::{Rect, vec2};

use crate::app::ui::kit::theme::GRID;
use crate::app::ui::ui_state::UiState;
use crate::transition::TransitionStop;

/// Range of t that the track shows by default before the first design and after the last one, as a
/// fraction of the range from the first to the last design.
const DEFAULT_MARGIN: f64 = 0.25;

/// Linear mapping between t and the x coordinate in the window, in points.
#[derive(Clone, Copy)]
pub struct TimelineRuler {
    left: f32,
    width: f32,
    /// y coordinate of the track's line.
    pub y: f32,
    /// Smallest t that the track shows.
    pub from: f64,
    /// Largest t that the track shows.
    pub to: f64,
    /// t of the last design.
    pub end: f64,
}

impl TimelineRuler {
    /// Creates the mapping for a track in `rect`, which shows the film, all stops and the current
    /// t.
    pub fn new(rect: Rect, state: &UiState, stops: &[TransitionStop]) -> Self {
        let timing = state.session.timing();
        let places = stops
            .iter()
            .map(|stop| stop.t)
            .chain([timing.from, timing.to]);
        // The current t may lie far outside the film. The track is extended to show it.
        let places = places.chain([state.playback.t()]);
        // The margin in t is proportional to the number of segments, so that its width on screen
        // does not depend on this number.
        let end = state.session.segment_count() as f64;
        let (mut from, mut to) = (-DEFAULT_MARGIN * end, (1.0 + DEFAULT_MARGIN) * end);
        for t in places {
            from = from.min(t);
            to = to.max(t);
        }
        let track = rect.shrink2(vec2(GRID, 0.0));
        Self {
            left: track.left(),
            width: track.width(),
            y: rect.top() + 34.0,
            from,
            to,
            end,
        }
    }

    /// Returns the x coordinate of `t`.
    pub fn x(&self, t: f64) -> f32 {
        self.left + ((t - self.from) / (self.to - self.from)) as f32 * self.width
    }

    /// Returns the t at the x coordinate `x`.
    pub fn t(&self, x: f32) -> f64 {
        self.from + f64::from((x - self.left) / self.width) * (self.to - self.from)
    }
}
