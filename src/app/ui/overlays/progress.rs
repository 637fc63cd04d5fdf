//! What is being worked on, how far it is, and a way to stop it.

use std::sync::Arc;

use bevy_egui::egui::{Align2, Context, Id, Margin, ProgressBar, Rect, Ui, vec2};
use image::RgbaImage;

use crate::app::input::intent::Intent;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{card, fixed_layer};
use crate::app::ui::ui_state::{Intents, UiState};

/// The longer side of the frame that a film has come to, in points.
const PICTURE: f32 = 120.0;

/// Draws a pill at the top of the stage for each piece of work.
pub fn show(ctx: &Context, scene: &UiState, stage: Rect, acts: &mut Intents) {
    let build = scene.session.told_work();
    let build = build.map(|work| (work, Intent::CancelWork));
    let film = scene.recorder.work();
    let film = film.map(|work| (work, Intent::CancelRecording));
    let choice = scene.choosing.told();
    let choice = choice.map(|share| (("trying methods", share), Intent::CancelChoice));
    let all: Vec<_> = build.into_iter().chain(choice).chain(film).collect();
    if all.is_empty() {
        return;
    }
    let at = stage.center_top() + vec2(0.0, 2.0 * GRID);
    fixed_layer("work", Align2::CENTER_TOP, at).show(ctx, |ui| {
        for ((stage, fraction), cancel) in all {
            let picture = match cancel {
                Intent::CancelRecording => scene.recorder.preview(),
                _ => None,
            };
            pill(ui, (stage, fraction), picture, cancel, acts);
        }
    });
}

fn pill(
    ui: &mut Ui,
    (stage, fraction): (&str, f64),
    picture: Option<Arc<RgbaImage>>,
    cancel: Intent,
    acts: &mut Intents,
) {
    card(ui, Margin::symmetric(16, 8), |ui| {
        ui.horizontal(|ui| {
            if let Some(picture) = picture {
                let texture = texture(ui.ctx(), Id::new("film"), &picture, u32::MAX);
                let size = texture.size_vec2();
                ui.image((texture.id(), size * (PICTURE / size.max_elem())));
            }
            ui.label(stage);
            let bar = ProgressBar::new(fraction as f32)
                .desired_width(120.0)
                .desired_height(6.0)
                .fill(ThemePalette::of(ui).accent);
            ui.add(bar);
            let tip = "Stops this work; what is on the stage stays (Esc).";
            if ui.button("Cancel").on_hover_text(tip).clicked() {
                acts.push(cancel);
            }
        });
    });
}
