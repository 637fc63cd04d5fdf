//! The strip at the bottom: transport and track.

use bevy_egui::egui::{Panel, Ui};

use crate::app::asking::intent::Intent;
use crate::app::ui::kit::widgets::ground;
use crate::app::ui::scene::{Intents, Scene};
use crate::app::ui::timeline::{track, transport};

const HEIGHT: f32 = 128.0;

/// Draws the timeline.
pub fn show(root: &mut Ui, scene: &Scene, acts: &mut Intents) {
    let frame = ground(root, [16, 16, 8, 8]);
    Panel::bottom("timeline")
        .exact_size(HEIGHT)
        .frame(frame)
        .show(root, |ui| {
            let Some(project) = scene.session.project() else {
                return;
            };
            let mut draft = project.clone();
            transport::show(ui, scene, &mut draft.timing, acts);
            track::show(ui, scene, &mut draft, acts);
            // Times and stops are a change of the project like any other, and can be undone.
            if draft != *project {
                acts.push(Intent::Edit(Box::new(draft)));
            }
        });
}
