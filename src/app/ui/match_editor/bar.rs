//! The line of tools at the upper edge of the match editor.

use bevy_egui::egui::{self, Align2, Context, Margin, Rect, vec2};

use crate::app::asking::acts::{EditorAct, Tool};
use crate::app::asking::intent::Intent;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{card, option, pinned, primary_button};
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
    let is_free = scene.sheet.is_free();
    // Lines move the plane, parts are of outlines.
    let tools = [
        (
            Tool::Pins,
            true,
            "Points",
            "Say which points are the same: click a boundary to pin it, drag a point to move it.",
        ),
        (
            Tool::Lines,
            is_free,
            "Lines",
            "Say which edges are the same: draw a line along one, then drag the ends of its \
             partner on the other side.",
        ),
        (
            Tool::Parts,
            !is_free,
            "Parts",
            "Say which parts are the same: click a part, then its partner on the other side, or beside all parts there if it has none.",
        ),
    ];
    for (tool, applies, name, tip) in tools {
        if applies && option(ui, scene.editor.tool == tool, name, tip, 52.0) {
            acts.push(Intent::Editor(EditorAct::Tool(tool)));
        }
    }
    if !scene.sheet.in_colours() {
        outline_tools(ui, scene, acts);
    }
    views(ui, scene, acts);
    ui.add_space(GRID);
    let tip = "Back to the stage (E or Esc). The match is kept.";
    if primary_button(ui, "Done").on_hover_text(tip).clicked() {
        acts.push(Intent::Editor(EditorAct::Toggle));
    }
}

/// What is shown beside the designs, and how all of it is looked at.
fn views(ui: &mut egui::Ui, scene: &Scene, acts: &mut Intents) {
    let panes = &scene.editor.panes;
    let mut act = |act: EditorAct| acts.push(Intent::Editor(act));
    ui.add_space(GRID);
    let tip = "The film beside the designs; it plays and is steered with the same keys.";
    if option(ui, panes.film, "Film", tip, 44.0) {
        act(EditorAct::Film(!panes.film));
    }
    let tip = "On: designs and film are moved and enlarged together. Off: each alone.";
    if option(ui, panes.together, "Zoom all", tip, 68.0) {
        act(EditorAct::Together(!panes.together));
    }
}

/// What only outlines have: corners, and triangles inside.
fn outline_tools(ui: &mut egui::Ui, scene: &Scene, acts: &mut Intents) {
    let editor = &scene.editor;
    let mut act = |act: EditorAct| acts.push(Intent::Editor(act));
    ui.add_space(GRID);
    let tip = "Pins jump to corners that are near. Hold Shift to do without for a moment.";
    if option(ui, editor.snaps, "Snap", tip, 52.0) {
        act(EditorAct::Snap(!editor.snaps));
    }
    let tip = "The triangles that both designs are divided into: the same ones on either side.";
    if option(ui, editor.triangles, "Triangles", tip, 68.0) {
        act(EditorAct::Triangles(!editor.triangles));
    }
}
