//! How pins and lines travel from the source to the target.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{list, section};
use crate::warp::Travel;

/// Draws the choice.
pub fn show(ui: &mut Ui, travel: &mut Travel) {
    section(ui, "Features", |ui| {
        list(ui, "Travel", "How pins and lines get there.", travel);
    });
}
