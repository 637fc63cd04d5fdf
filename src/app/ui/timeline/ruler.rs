//! Where on the timeline a t lies.

use bevy_egui::egui::{Rect, vec2};

use crate::app::ui::kit::theme::GRID;
use crate::app::ui::ui_state::UiState;
use crate::transition::TransitionStop;

/// How far the track reaches beyond 0 and 1 when nothing asks for more.
const BEYOND: f64 = 0.25;

/// From t to the screen and back.
#[derive(Clone, Copy)]
pub struct TimelineRuler {
    left: f32,
    width: f32,
    /// The height of its line on the screen.
    pub y: f32,
    /// The first t that it shows.
    pub from: f64,
    /// The last one.
    pub to: f64,
    /// The t of the last design.
    pub end: f64,
}

impl TimelineRuler {
    /// Over all that the track has to show.
    pub fn new(rect: Rect, scene: &UiState, stops: &[TransitionStop]) -> Self {
        let timing = scene.session.timing();
        let places = stops
            .iter()
            .map(|stop| stop.t)
            .chain([timing.from, timing.to]);
        // Also t itself: typed or played far outside, it must be seen.
        let places = places.chain([scene.playback.t()]);
        // As much of the strip, whatever the number of legs.
        let end = scene.session.leg_count() as f64;
        let (mut from, mut to) = (-BEYOND * end, (1.0 + BEYOND) * end);
        for t in places {
            from = from.min(t);
            to = to.max(t);
        }
        let line = rect.shrink2(vec2(GRID, 0.0));
        Self {
            left: line.left(),
            width: line.width(),
            y: rect.top() + 34.0,
            from,
            to,
            end,
        }
    }

    /// Where a t is on the screen.
    pub fn x(&self, t: f64) -> f32 {
        self.left + ((t - self.from) / (self.to - self.from)) as f32 * self.width
    }

    /// Which t is at that place of the screen.
    pub fn t(&self, x: f32) -> f64 {
        self.from + f64::from((x - self.left) / self.width) * (self.to - self.from)
    }
}
