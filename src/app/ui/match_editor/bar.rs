//! The line of tools at the upper edge of the match editor.

use bevy_egui::egui::{self, Align2, Context, Margin, Rect, vec2};

use crate::app::asking::acts::{EditorAct, Tool};
use crate::app::asking::intent::Intent;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID};
use crate::app::ui::kit::widgets::{card, choice, pinned, primary_button};
use crate::app::ui::scene::{Intents, Scene};

/// Its height with the space above it.
pub const BAR_HEIGHT: f32 = 48.0;

/// Height of the line of advice at the lower edge.
pub const ADVICE_HEIGHT: f32 = 40.0;

/// Draws it.
pub fn show(ctx: &Context, scene: &Scene, stage: Rect, acts: &mut Intents) {
    let at = stage.center_top() + vec2(0.0, GRID);
    pinned("match tools", Align2::CENTER_TOP, at).show(ctx, |ui| {
        card(ui, Margin::symmetric(8, 6), |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                tools(ui, scene, acts);
            });
        });
    });
}

fn tools(ui: &mut egui::Ui, scene: &Scene, acts: &mut Intents) {
    let editor = &scene.editor;
    let mut act = |act: EditorAct| acts.push(Intent::Editor(act));
    let size = vec2(52.0, CONTROL_HEIGHT);
    let tools = [
        (
            Tool::Pins,
            "Points",
            "Say which points are the same: click a boundary to pin it, drag a point to move it.",
        ),
        (
            Tool::Lines,
            "Lines",
            "Say which edges are the same: draw a line along one, then drag the ends of its \
             partner on the other side.",
        ),
        (
            Tool::Parts,
            "Parts",
            "Say which parts are the same: click a part, then its partner on the other side.",
        ),
    ];
    let is_free = scene.sheet.is_free();
    for (tool, name, tip) in tools {
        // Lines move the plane, parts are of outlines.
        let applies = match tool {
            Tool::Pins => true,
            Tool::Lines => is_free,
            Tool::Parts => !is_free,
        };
        if !applies {
            continue;
        }
        let response = choice(ui, editor.tool == tool, name, size);
        if response.on_hover_text(tip).clicked() {
            act(EditorAct::Tool(tool));
        }
    }
    if !scene.sheet.in_colours() {
        outline_tools(ui, scene, acts);
    }
    ui.add_space(GRID);
    let mut act = |act: EditorAct| acts.push(Intent::Editor(act));
    let tip = "Back to the stage (E or Esc). The match is kept.";
    if primary_button(ui, "Done").on_hover_text(tip).clicked() {
        act(EditorAct::Toggle);
    }
}

/// What only outlines have: corners, and triangles inside.
fn outline_tools(ui: &mut egui::Ui, scene: &Scene, acts: &mut Intents) {
    let editor = &scene.editor;
    let mut act = |act: EditorAct| acts.push(Intent::Editor(act));
    let size = vec2(52.0, CONTROL_HEIGHT);
    ui.add_space(GRID);
    let tip = "Pins jump to corners that are near. Hold Shift to do without for a moment.";
    if choice(ui, editor.snaps, "Snap", size)
        .on_hover_text(tip)
        .clicked()
    {
        act(EditorAct::Snap(!editor.snaps));
    }
    let tip = "The triangles that both designs are divided into: the same ones on either side.";
    let size = vec2(68.0, CONTROL_HEIGHT);
    if choice(ui, editor.triangles, "Triangles", size)
        .on_hover_text(tip)
        .clicked()
    {
        act(EditorAct::Triangles(!editor.triangles));
    }
}
