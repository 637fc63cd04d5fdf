//! The line of tools at the upper edge of the match editor.

use bevy_egui::egui::{self, Align2, Context, Margin, Rect, vec2};

use crate::app::input::editor_action::{EditorAction, EditorTool};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{card, choice_button, fixed_layer, primary_button};
use crate::app::ui::ui_state::{Intents, UiState};

/// Its height with the space above it.
pub const BAR_HEIGHT: f32 = 48.0;

/// Height of the line of advice at the lower edge.
pub const ADVICE_HEIGHT: f32 = 40.0;

/// Draws it.
pub fn show(ctx: &Context, scene: &UiState, stage: Rect, acts: &mut Intents) {
    let at = stage.center_top() + vec2(0.0, GRID);
    fixed_layer("match tools", Align2::CENTER_TOP, at).show(ctx, |ui| {
        card(ui, Margin::symmetric(8, 6), |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                tools(ui, scene, acts);
            });
        });
    });
}

fn tools(ui: &mut egui::Ui, scene: &UiState, acts: &mut Intents) {
    let is_free = scene.sheet.is_free();
    // Lines move the plane, parts are of outlines.
    let tools = [
        (
            EditorTool::Pins,
            true,
            "Points",
            "Say which points are the same: click a boundary to pin it, drag a point to move it.",
        ),
        (
            EditorTool::Lines,
            is_free,
            "Lines",
            "Say which edges are the same: draw a line along one, then drag the ends of its \
             partner on the other side.",
        ),
        (
            EditorTool::Parts,
            !is_free,
            "Parts",
            "Say which parts are the same: click a part, then its partner on the other side, or beside all parts there if it has none.",
        ),
    ];
    for (tool, applies, name, tip) in tools {
        if applies && choice_button(ui, scene.editor.tool == tool, name, tip, 52.0) {
            acts.push(Intent::Editor(EditorAction::Tool(tool)));
        }
    }
    if !scene.sheet.in_colours() {
        outline_tools(ui, scene, acts);
    }
    views(ui, scene, acts);
    ui.add_space(GRID);
    let tip = "Back to the stage (E or Esc). The match is kept.";
    if primary_button(ui, "Done").on_hover_text(tip).clicked() {
        acts.push(Intent::Editor(EditorAction::Toggle));
    }
}

/// What is shown beside the designs, and how all of it is looked at.
fn views(ui: &mut egui::Ui, scene: &UiState, acts: &mut Intents) {
    let panes = &scene.editor.panes;
    let mut act = |act: EditorAction| acts.push(Intent::Editor(act));
    ui.add_space(GRID);
    let tip = "The film beside the designs; it plays and is steered with the same keys.";
    if choice_button(ui, panes.film, "Film", tip, 44.0) {
        act(EditorAction::Film(!panes.film));
    }
    let tip = "On: designs and film are moved and enlarged together. Off: each alone.";
    if choice_button(ui, panes.together, "Zoom all", tip, 68.0) {
        act(EditorAction::Together(!panes.together));
    }
}

/// What only outlines have: corners, and triangles inside.
fn outline_tools(ui: &mut egui::Ui, scene: &UiState, acts: &mut Intents) {
    let editor = &scene.editor;
    let mut act = |act: EditorAction| acts.push(Intent::Editor(act));
    ui.add_space(GRID);
    let tip = "Pins jump to corners that are near. Hold Shift to do without for a moment.";
    if choice_button(ui, editor.snaps, "Snap", tip, 52.0) {
        act(EditorAction::Snap(!editor.snaps));
    }
    let tip = "The triangles that both designs are divided into: the same ones on either side.";
    if choice_button(ui, editor.triangles, "Triangles", tip, 68.0) {
        act(EditorAction::Triangles(!editor.triangles));
    }
}
