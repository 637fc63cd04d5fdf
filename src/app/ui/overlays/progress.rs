//! Cards that show the progress of background jobs, each with a button to cancel the job.

use std::sync::Arc;

use bevy_egui::egui::{Align2, Context, Id, Margin, ProgressBar, Rect, Ui, vec2};
use image::RgbaImage;

use crate::app::input::intent::Intent;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{card, fixed_layer};
use crate::app::ui::ui_state::{Intents, UiState};

/// Length of the longer side of the image that shows the current frame of an export, in points.
const PREVIEW_SIDE: f32 = 120.0;

/// Draws a card for each running job (build, method search, export) at the top of `stage`.
pub fn show(ctx: &Context, state: &UiState, stage: Rect, intents: &mut Intents) {
    let build = state.session.visible_work();
    let build = build.map(|work| (work, Intent::CancelWork));
    let export = state.exporter.work();
    let export = export.map(|work| (work, Intent::CancelExport));
    let choice = state.method_search.visible_progress();
    let choice = choice.map(|fraction| (("Trying methods", fraction), Intent::CancelMethodSearch));
    let all: Vec<_> = build.into_iter().chain(choice).chain(export).collect();
    if all.is_empty() {
        return;
    }
    let at = stage.center_top() + vec2(0.0, 2.0 * GRID);
    fixed_layer("work", Align2::CENTER_TOP, at).show(ctx, |ui| {
        for ((stage, fraction), cancel) in all {
            let picture = match cancel {
                Intent::CancelExport => state.exporter.preview(),
                _ => None,
            };
            progress_card(ui, stage, fraction, picture, cancel, intents);
        }
    });
}

fn progress_card(
    ui: &mut Ui,
    stage: &str,
    fraction: f64,
    picture: Option<Arc<RgbaImage>>,
    cancel: Intent,
    intents: &mut Intents,
) {
    card(ui, Margin::symmetric(16, 8), |ui| {
        ui.horizontal(|ui| {
            if let Some(picture) = picture {
                let texture = texture(ui.ctx(), Id::new("film"), &picture, u32::MAX);
                let size = texture.size_vec2();
                ui.image((texture.id(), size * (PREVIEW_SIDE / size.max_elem())));
            }
            ui.label(stage);
            let bar = ProgressBar::new(fraction as f32)
                .desired_width(120.0)
                .desired_height(6.0)
                .fill(ThemePalette::of(ui).accent);
            ui.add(bar);
            let tip = "Cancels this job; the stage keeps what it shows (Esc).";
            if ui.button("Cancel").on_hover_text(tip).clicked() {
                intents.push(cancel);
            }
        });
    });
}
