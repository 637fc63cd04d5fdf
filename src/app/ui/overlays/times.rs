//! Where a frame's time goes.

use bevy_egui::egui::{Align2, Context, Grid, Rect, Ui, vec2};

use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{card, pinned, quiet};
use crate::app::ui::scene::Scene;

/// Draws the table of times at the upper right of the stage.
pub fn show(ctx: &Context, scene: &Scene, stage: Rect) {
    let at = stage.right_top() + vec2(-2.0 * GRID, 2.0 * GRID);
    let area = pinned("times", Align2::RIGHT_TOP, at).interactable(false);
    area.show(ctx, |ui| card(ui, 12, |ui| table(ui, scene)));
}

fn table(ui: &mut Ui, scene: &Scene) {
    ui.label(quiet(ui, "Median of the last frames"));
    let stages = [
        ("Solve", &scene.times.solve),
        ("Draw", &scene.times.draw),
        ("Whole frame", &scene.whole.0),
    ];
    Grid::new("times").spacing([24.0, 4.0]).show(ui, |ui| {
        for (stage, durations) in stages {
            ui.label(stage);
            let time = durations.median().map(|time| time.as_secs_f64() * 1e3);
            let text = time.map_or("–".to_owned(), |ms| format!("{ms:7.2} ms"));
            ui.monospace(text);
            ui.end_row();
        }
    });
}
