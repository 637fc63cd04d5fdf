//! On which paths the points of an outline move.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{choices, row, section};
use crate::warp::{Course, PathOptions};

/// Draws the options.
pub fn show(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        row(ui, "Course", "How each point of the outline moves.", |ui| {
            choices(
                ui,
                &mut paths.course,
                &[
                    (
                        Course::Straight,
                        "Straight",
                        "On straight lines: what turns shrinks on the way",
                    ),
                    (
                        Course::Intrinsic,
                        "Intrinsic",
                        "Edges turn and change their lengths evenly: what turns keeps its form",
                    ),
                ],
            )
        });
    });
}
