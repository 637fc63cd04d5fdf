//! How outlines are matched and triangulated: the rules, and the way to the match editor.

use bevy_egui::egui::Ui;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::widgets::{
    automatic_toggle, choice_row, choices_row, hint, section, slider,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::correspondence::MatchSettings;
use crate::project::Project;
use crate::warp::WarpKind;

/// The edge length, as a share of the design, that density starts from when it is set by hand.
const USUAL_EDGE: f64 = 0.05;

/// Draws the options.
pub fn show(ui: &mut Ui, scene: &UiState, draft: &mut Project, acts: &mut Intents) {
    // Rigid parts are made of triangles, those that carry a field too.
    let has_mesh =
        draft.warp == Some(WarpKind::Arap) && draft.content != Some(ContentKind::Colours);
    section(ui, "Match", |ui| {
        if draft.content != Some(ContentKind::Colours) {
            rules(ui, &mut draft.options.matching);
        }
        if draft.warp == Some(WarpKind::Arap) && draft.content == Some(ContentKind::Solid) {
            let tip = "How much is tried for the film: the first match, or the best of several.";
            choice_row(ui, "Film", tip, &mut draft.options.quality);
            let tip = "What is done where the film would fold, or its outlines would meet. Only \
                       the best film is guarded: the first one is there at once.";
            choice_row(ui, "Guard", tip, &mut draft.options.guard);
        }
        if has_mesh {
            density(ui, &mut draft.options.triangulation.edge_length);
        }
        ui.add_space(4.0);
        hint(ui, &said(&draft.options.matching));
        ui.horizontal(|ui| {
            let (name, tip) = if scene.editor.is_open {
                ("Back to the stage", "The match is kept (E or Esc).")
            } else {
                (
                    "Edit the match",
                    "Shows source and target side by side: which point is which, and what to \
                     change about it (E).",
                )
            };
            if ui.button(name).on_hover_text(tip).clicked() {
                acts.push(Intent::Editor(EditorAction::Toggle));
            }
            let tip = "Deletes all pins, pairs and cuts that were set by hand; can be undone.";
            if has_places(&draft.options.matching)
                && ui.button("Clear").on_hover_text(tip).clicked()
            {
                acts.push(Intent::Editor(EditorAction::Clear));
            }
        });
    });
}

fn rules(ui: &mut Ui, matching: &mut MatchSettings) {
    let tip = "Whether a shape may be matched with one that is turned.";
    let turning = [
        (false, "Free", "A shape is found again however it is turned"),
        (
            true,
            "Keep up",
            "What points up stays what points up, as with letters",
        ),
    ];
    choices_row(ui, "Turning", tip, &mut matching.keep_up, &turning);
    let tip = "What becomes of a hole that the other design does not have.";
    choice_row(ui, "Holes", tip, &mut matching.holes);
    let tip = "What becomes of a part that the other design does not have.";
    choice_row(ui, "Parts", tip, &mut matching.parts);
}

fn density(ui: &mut Ui, edge_length: &mut Option<f64>) {
    let tip = "Triangles as coarse as good angles allow. Off: a largest edge length of your own.";
    automatic_toggle(ui, "Auto mesh", tip, edge_length, USUAL_EDGE);
    if let Some(length) = edge_length {
        let tip = "The longest edge wanted inside, as a share of the design's size: smaller makes more \
             triangles, softer bends and slower frames.";
        slider(ui, "Edge length", tip, length, 0.01..=0.25, true);
    }
}

fn has_places(matching: &MatchSettings) -> bool {
    let MatchSettings {
        pins,
        lines,
        links,
        lone,
        cuts,
        ..
    } = matching;
    !(pins.is_empty() && lines.is_empty() && links.is_empty() && lone.is_empty() && cuts.is_empty())
}

fn said(matching: &MatchSettings) -> String {
    if !has_places(matching) {
        return "Nothing was set by hand yet. Outlines match themselves; pictures need pins or \
                lines."
            .to_owned();
    }
    let count = |n: usize, one: &str, many: &str| match n {
        0 => None,
        1 => Some(format!("1 {one}")),
        n => Some(format!("{n} {many}")),
    };
    let all = [
        count(matching.pins.len(), "pin", "pins"),
        count(matching.lines.len(), "line", "lines"),
        count(matching.links.len(), "pair of parts", "pairs of parts"),
        count(matching.lone.len(), "part alone", "parts alone"),
        count(matching.cuts.len(), "cut", "cuts"),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    format!("Set by hand: {}.", all.join(", "))
}
