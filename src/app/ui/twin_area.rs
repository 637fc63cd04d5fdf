//! Two methods side by side: the stage on the left, a second method on the right.

use bevy_egui::egui::{Align2, Area, Frame, Margin, Order, Rect, RichText, Stroke, Ui, pos2, vec2};

use super::stage_area::{self, ink_on};
use super::theme::{CARD_RADIUS, CONTROL_HEIGHT, GRID, Palette};
use super::widgets::choice;
use super::{Intents, Scene, method_panel, verdict};
use crate::app::intent::Intent;
use crate::app::twin::TwinMethod;

/// Draws what lies above both; returns the part that the stage takes.
pub fn show(root: &mut Ui, scene: &Scene, stage: Rect, acts: &mut Intents) -> Rect {
    let half = vec2((stage.width() / 2.0).floor(), stage.height());
    let left = Rect::from_min_size(stage.min, half);
    let right = left.translate(vec2(half.x, 0.0));
    stage_area::show(root, scene, left, "stage", acts);
    stage_area::show(root, scene, right, "twin", acts);
    verdict::mark(root, scene, left);
    let ground = scene
        .session
        .project()
        .map_or_else(Default::default, |project| project.style)
        .ground;
    let ink = ink_on(ground);
    let line = Stroke::new(1.0, ink.gamma_multiply(0.5));
    root.painter().vline(right.left(), stage.y_range(), line);
    missing(root, scene, right);
    first_name(root, scene, left);
    second_name(root, scene, right, acts);
    left
}

/// What the right half says while it is empty.
fn missing(ui: &Ui, scene: &Scene, rect: Rect) {
    let twin = &scene.twin;
    let words = match (twin.transition(), twin.problem()) {
        (Some(_), _) => return,
        (None, Some(problem)) => problem.to_owned(),
        (None, None) if twin.is_busy() => "Building …".to_owned(),
        (None, None) => return,
    };
    let ground = scene
        .session
        .project()
        .map_or_else(Default::default, |project| project.style)
        .ground;
    let font = bevy_egui::egui::FontId::proportional(14.0);
    let width = rect.width() - 4.0 * GRID;
    let galley = ui.painter().layout(words, font, ink_on(ground), width);
    let at = Align2::CENTER_CENTER.anchor_size(rect.center(), galley.size());
    ui.painter().galley(at.min, galley, ink_on(ground));
}

fn first_name(ui: &Ui, scene: &Scene, rect: Rect) {
    let Some(transition) = scene.session.transition() else {
        return;
    };
    let cell = transition.cell();
    let name = method_panel::cell_name(cell.warp(), cell.content());
    card(ui, "first method", rect, |ui| {
        let weak = Palette::of(ui).weak;
        ui.add_sized(
            [84.0, CONTROL_HEIGHT],
            bevy_egui::egui::Label::new(RichText::new(name).small().color(weak)),
        )
        .on_hover_text("The method of the project, as it is chosen on the right of the window.");
    });
}

fn second_name(ui: &Ui, scene: &Scene, rect: Rect, acts: &mut Intents) {
    card(ui, "second method", rect, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for method in TwinMethod::ALL {
            let (warp, content) = method.cell();
            let available = scene.session.available(warp, content);
            let (name, tip) = words(method);
            ui.add_enabled_ui(available.is_ok(), |ui| {
                let size = vec2(52.0, CONTROL_HEIGHT);
                let response = choice(ui, scene.twin.method == method, name, size);
                let response = response.on_hover_text(tip);
                if let Err(reason) = &available {
                    response.on_disabled_hover_text(format!("Not available: {reason}"));
                } else if response.clicked() {
                    acts.push(Intent::TwinMethod(method));
                }
            });
        }
    });
}

fn words(method: TwinMethod) -> (&'static str, &'static str) {
    match method {
        TwinMethod::Straight => (
            "Straight",
            "Each point goes straight to its place: what turns shrinks on the way.",
        ),
        TwinMethod::Rigid => (
            "Rigid",
            "Each part moves as rigidly as it can: limbs turn instead of shrinking.",
        ),
        TwinMethod::Field => (
            "Field",
            "How far each point lies from the two outlines is blended; nothing moves.",
        ),
    }
}

/// A card at the top of a half.
fn card(ui: &Ui, name: &'static str, rect: Rect, content: impl FnOnce(&mut Ui)) {
    Area::new(name.into())
        .order(Order::Middle)
        .pivot(Align2::CENTER_TOP)
        .fixed_pos(pos2(rect.center().x, rect.top() + GRID))
        .show(ui.ctx(), |ui| {
            Frame::window(ui.style())
                .corner_radius(CARD_RADIUS)
                .inner_margin(Margin::symmetric(6, 4))
                .show(ui, |ui| ui.horizontal(content));
        });
}
