//! How pins and lines travel from the source to the target.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{menu, row, section};
use crate::warp::Travel;

const TRAVELS: [(Travel, &str, &str); 3] = [
    (
        Travel::Auto,
        "Auto",
        "As a whole where fields are seen, straight where pictures are.",
    ),
    (
        Travel::Whole,
        "As a whole",
        "What turns keeps its size on the way; the borders of pictures turn too.",
    ),
    (
        Travel::Straight,
        "Straight",
        "Each goes the shortest way; what turns far shrinks on the way.",
    ),
];

/// Draws the choice.
pub fn show(ui: &mut Ui, travel: &mut Travel) {
    section(ui, "Features", |ui| {
        row(ui, "Travel", "How pins and lines get there.", |ui| {
            menu(ui, "travel", travel, &TRAVELS)
        });
    });
}
