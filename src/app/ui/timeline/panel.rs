//! Timeline panel at the bottom of the window: playback controls, and below them the track with its
//! film strip.

use bevy_egui::egui::{Panel, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::widgets::panel_frame;
use crate::app::ui::timeline::{filmstrip, track, transport};
use crate::app::ui::ui_state::{Intents, UiState};

/// Height of the timeline without the film strip, in points.
const HEIGHT: f32 = 128.0;

/// Minimum height of the window below the toolbar at which the film strip is shown, in points.
const MIN_HEIGHT_WITH_FILMSTRIP: f32 = 600.0;

/// Draws the timeline, and sends changes of timing and stops.
pub fn show(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = panel_frame(root, [16, 16, 8, 8]);
    let has_pictures = root.available_height() >= MIN_HEIGHT_WITH_FILMSTRIP;
    let filmstrip_height = if has_pictures { filmstrip::HEIGHT } else { 0.0 };
    Panel::bottom("timeline")
        .exact_size(HEIGHT + filmstrip_height)
        .frame(frame)
        .show(root, |ui| {
            let Some(project) = state.session.project() else {
                return;
            };
            let mut draft = project.clone();
            transport::show(ui, state, &mut draft.timing, intents);
            track::show(ui, state, &mut draft, has_pictures, intents);
            // Timing and stops belong to the project, so changes of them can be undone.
            if draft != *project {
                intents.push(Intent::ReplaceSettings(Box::new(draft)));
            }
        });
}
