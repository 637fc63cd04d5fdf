//! Where a frame's time goes.

use bevy_egui::egui::{Align2, Area, Context, Grid, Order, Rect, RichText, vec2};

use crate::app::ui::kit::theme::{GRID, Palette};
use crate::app::ui::kit::widgets::card;
use crate::app::ui::scene::Scene;
use crate::stage::Durations;

/// Draws the table of times at the upper right of the stage.
pub fn show(ctx: &Context, scene: &Scene, stage: Rect) {
    Area::new("times".into())
        .order(Order::Middle)
        .interactable(false)
        .pivot(Align2::RIGHT_TOP)
        .fixed_pos(stage.right_top() + vec2(-2.0 * GRID, 2.0 * GRID))
        .show(ctx, |ui| {
            card(ui, 12, |ui| {
                let weak = Palette::of(ui).weak;
                ui.label(
                    RichText::new("Median of the last frames")
                        .small()
                        .color(weak),
                );
                Grid::new("times")
                    .num_columns(2)
                    .spacing([24.0, 4.0])
                    .show(ui, |ui| {
                        for (stage, durations) in stages(scene) {
                            ui.label(stage);
                            let time = durations.median().map(|time| time.as_secs_f64() * 1e3);
                            let text = time.map_or("–".to_owned(), |ms| format!("{ms:7.2} ms"));
                            ui.label(RichText::new(text).monospace());
                            ui.end_row();
                        }
                    });
            });
        });
}

fn stages<'a>(scene: &'a Scene) -> [(&'static str, &'a Durations); 3] {
    [
        ("Solve", &scene.times.solve),
        ("Draw", &scene.times.draw),
        ("Whole frame", &scene.whole.0),
    ]
}
