//! On which paths the points of an outline move.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{choose, section};
use crate::warp::{Course, PathOptions};

/// Draws the options.
pub fn show(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        choose(
            ui,
            "Course",
            "How each point of the outline moves.",
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
        );
    });
}
