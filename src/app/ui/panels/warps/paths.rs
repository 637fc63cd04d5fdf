//! On which paths the points of an outline move.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{pick, section};
use crate::warp::PathOptions;

/// Draws the options.
pub fn show(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        let tip = "How each point of the outline moves.";
        pick(ui, "Course", tip, &mut paths.course);
    });
}
