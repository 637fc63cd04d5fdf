//! The verdict on the transition: one line at the lower left of the stage, and where it points to.

use bevy_egui::egui::{
    self, Align2, Area, Context, Label, Order, Rect, RichText, Sense, Stroke, Ui, pos2, vec2,
};

use super::icons::{self, Icon};
use super::stage_area::ink_on;
use super::theme::{CARD_RADIUS, GRID, Palette};
use super::{Intents, Scene};
use crate::app::intent::Intent;
use crate::app::measuring::{Measures, is_a_click};
use crate::measure::Finding;

/// Height that the line takes at the lower edge of the stage.
pub const HEIGHT: f32 = 40.0;

/// How near t must be for the place of a finding to be marked.
const NEAR_T: f64 = 0.02;

/// Draws the line.
pub fn show(ctx: &Context, scene: &Scene, stage: Rect, acts: &mut Intents) {
    let Some(measures) = scene.measured.measures() else {
        return;
    };
    Area::new("verdict".into())
        .order(Order::Middle)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(stage.left_bottom() + vec2(GRID, -GRID))
        .show(ctx, |ui| {
            ui.set_max_width(stage.width() - 2.0 * GRID);
            egui::Frame::window(ui.style())
                .corner_radius(CARD_RADIUS)
                .inner_margin(egui::Margin::symmetric(8, 4))
                .show(ui, |ui| line(ui, scene, measures, stage, acts));
        });
}

fn line(ui: &mut Ui, scene: &Scene, measures: &Measures, stage: Rect, acts: &mut Intents) {
    let palette = Palette::of(ui);
    let verdict = &measures.verdict;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (icon, colour) = if verdict.is_clear() {
            (Icon::Tick, palette.good)
        } else {
            (Icon::Warning, palette.amber)
        };
        let (rect, _) = ui.allocate_exact_size(vec2(16.0, 20.0), Sense::hover());
        icons::paint(ui.painter(), icon, rect, colour);
        if verdict.is_clear() {
            let tip = format!(
                "Looked at {} moments from the source to the target.",
                verdict.steps
            );
            ui.label(RichText::new(first_upper(verdict.clear)).small())
                .on_hover_text(tip);
            return;
        }
        let room = stage.width() - 8.0 * GRID;
        for (index, finding) in verdict.findings.iter().enumerate() {
            one(ui, scene, (index, finding), room, acts);
        }
    });
}

fn one(
    ui: &mut Ui,
    scene: &Scene,
    (index, finding): (usize, &Finding),
    room: f32,
    acts: &mut Intents,
) {
    let palette = Palette::of(ui);
    ui.set_max_width(room);
    let text = RichText::new(first_upper(&finding.headline()))
        .small()
        .color(palette.amber);
    let response = ui.add(Label::new(text).truncate().sense(Sense::click()));
    if response.hovered() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    let is_there = (scene.playback.t() - finding.t).abs() < 1e-9;
    if response.clicked() {
        acts.push(Intent::Seek(finding.t));
    }
    let go = if is_there {
        "The place is marked on the stage."
    } else {
        "Click to go there."
    };
    let tip = format!(
        "Why: {}.\nWhat helps: {}.\n{go}",
        finding.cause, finding.remedy
    );
    response.on_hover_text(tip);
    if is_a_click(&finding.remedy) {
        let tip = format!(
            "{}. Can be undone.",
            first_upper(&finding.remedy.to_string())
        );
        if ui.small_button("Fix").on_hover_text(tip).clicked() {
            acts.push(Intent::TakeAdvice(index));
        }
    }
}

fn first_upper(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map(|first| first.to_uppercase().chain(chars).collect())
        .unwrap_or_default()
}

/// Marks the place of each finding on the stage while t is there.
pub fn mark(ui: &Ui, scene: &Scene, stage: Rect) {
    let Some(measures) = scene.measured.measures() else {
        return;
    };
    let ground = scene.session.project().map(|p| p.style.ground);
    let Some(ground) = ground else {
        return;
    };
    let is_light = ink_on(ground).r() < 0x80;
    let colour = Palette::on(is_light).amber;
    let painter = ui.painter().with_clip_rect(stage);
    for finding in &measures.verdict.findings {
        if (scene.playback.t() - finding.t).abs() > NEAR_T {
            continue;
        }
        let px = scene.view.px_from_world(finding.place);
        let at = stage.min + vec2(px.x, px.y);
        painter.circle_stroke(at, 16.0, Stroke::new(2.0, colour));
        for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            let ray = vec2(dx, dy);
            let ends = [at + 16.0 * ray, at + 22.0 * ray];
            painter.line_segment(ends.map(|p| pos2(p.x, p.y)), Stroke::new(2.0, colour));
        }
    }
}
