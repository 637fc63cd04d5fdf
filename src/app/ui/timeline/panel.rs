//! The strip at the bottom: transport and track.

use bevy_egui::egui::{Panel, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::widgets::panel_frame;
use crate::app::ui::timeline::{filmstrip, track, transport};
use crate::app::ui::ui_state::{Intents, UiState};

const HEIGHT: f32 = 128.0;

/// A window that leaves less than this to all that lies below the toolbar has no room for pictures.
const ROOMY: f32 = 600.0;

/// Draws the timeline.
pub fn show(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let frame = panel_frame(root, [16, 16, 8, 8]);
    let has_pictures = root.available_height() >= ROOMY;
    let pictures = if has_pictures { filmstrip::HEIGHT } else { 0.0 };
    Panel::bottom("timeline")
        .exact_size(HEIGHT + pictures)
        .frame(frame)
        .show(root, |ui| {
            let Some(project) = scene.session.project() else {
                return;
            };
            let mut draft = project.clone();
            transport::show(ui, scene, &mut draft.timing, acts);
            track::show(ui, scene, &mut draft, has_pictures, acts);
            // Times and stops are a change of the project like any other, and can be undone.
            if draft != *project {
                acts.push(Intent::Edit(Box::new(draft)));
            }
        });
}
