//! Timeline panel at the bottom: transport controls, and the track below them.

use bevy_egui::egui::{Panel, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::widgets::panel_frame;
use crate::app::ui::timeline::{filmstrip, track, transport};
use crate::app::ui::ui_state::{Intents, UiState};

/// Height of the panel without the film strip, in points.
const HEIGHT: f32 = 128.0;

/// Height below the toolbar from which the film strip is shown, in points.
const MIN_HEIGHT_WITH_FILMSTRIP: f32 = 600.0;

/// Draws the timeline.
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
            // Timing and stops belong to the project, so changing them can be undone.
            if draft != *project {
                intents.push(Intent::ReplaceSettings(Box::new(draft)));
            }
        });
}
