//! Toolbar of the match editor: choice of the tool, options for outlines, and options of the
//! panes' views.

use bevy_egui::egui::{self, Align2, Context, Margin, Rect, vec2};

use crate::app::input::editor_action::{EditorAction, EditorTool};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{card, fixed_layer, primary_button, segment_button};
use crate::app::ui::ui_state::{Intents, UiState};

/// Height of the match editor's toolbar including the space above it, in points.
pub const BAR_HEIGHT: f32 = 48.0;

/// Height of the line of instructions at the lower edge of the match editor, in points.
pub const INSTRUCTIONS_HEIGHT: f32 = 40.0;

/// Draws the toolbar of the match editor at the top of `stage`.
pub fn show(ctx: &Context, state: &UiState, stage: Rect, intents: &mut Intents) {
    let at = stage.center_top() + vec2(0.0, GRID);
    fixed_layer("match tools", Align2::CENTER_TOP, at).show(ctx, |ui| {
        card(ui, Margin::symmetric(8, 6), |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                tools(ui, state, intents);
            });
        });
    });
}

fn tools(ui: &mut egui::Ui, state: &UiState, intents: &mut Intents) {
    let is_free = state.sheet.has_free_pins();
    // The line tool is offered only for warps of the whole plane, the part tool only for matches of
    // outlines.
    let tools = [
        (
            EditorTool::Pins,
            true,
            "Points",
            "Pin points that belong together: click a boundary to add a pin, drag a point to move \
             it.",
        ),
        (
            EditorTool::Lines,
            is_free,
            "Lines",
            "Pair edges that belong together: draw a line along one, then drag the ends of its \
             copy on the other side.",
        ),
        (
            EditorTool::Parts,
            !is_free,
            "Parts",
            "Pair parts: click a part, then its partner on the other side, or empty space there if \
             it has none.",
        ),
    ];
    for (tool, applies, name, tip) in tools {
        if applies && segment_button(ui, state.editor.tool == tool, name, tip, 52.0) {
            intents.push(Intent::Editor(EditorAction::SelectTool(tool)));
        }
    }
    if !state.sheet.shows_pictures() {
        outline_tools(ui, state, intents);
    }
    views(ui, state, intents);
    ui.add_space(GRID);
    let tip = "Return to the stage (E or Esc). The match is kept.";
    if primary_button(ui, "Done").on_hover_text(tip).clicked() {
        intents.push(Intent::Editor(EditorAction::Toggle));
    }
}

/// Draws the button that shows the film pane, and the button that makes all panes pan and zoom
/// together.
fn views(ui: &mut egui::Ui, state: &UiState, intents: &mut Intents) {
    let panes = &state.editor.panes;
    let mut send = |action: EditorAction| intents.push(Intent::Editor(action));
    ui.add_space(GRID);
    let tip = "Shows the film next to the designs. The usual keys play and scrub it.";
    if segment_button(ui, panes.film, "Film", tip, 44.0) {
        send(EditorAction::ShowFilm(!panes.film));
    }
    let tip = "On: all panes pan and zoom together. Off: each separately.";
    if segment_button(ui, panes.are_linked, "Link views", tip, 68.0) {
        send(EditorAction::LinkPanes(!panes.are_linked));
    }
}

/// Draws the buttons that apply only to outlines: snapping to corners, and showing the triangles
/// of the mesh.
fn outline_tools(ui: &mut egui::Ui, state: &UiState, intents: &mut Intents) {
    let editor = &state.editor;
    let mut send = |action: EditorAction| intents.push(Intent::Editor(action));
    ui.add_space(GRID);
    let tip = "Snaps pins to nearby corners. Hold Shift to place a pin freely.";
    if segment_button(ui, editor.snaps, "Snap", tip, 52.0) {
        send(EditorAction::SetSnapping(!editor.snaps));
    }
    let tip = "Shows the triangles that divide both designs, the same ones on either side.";
    if segment_button(ui, editor.triangles, "Triangles", tip, 68.0) {
        send(EditorAction::ShowTriangles(!editor.triangles));
    }
}
