//! Match section of the inspector: rules for matching outlines, number of matches that are tried,
//! avoidance of collisions, density of the mesh, and the button that opens the match editor.

use bevy_egui::egui::Ui;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::widgets::{
    automatic_toggle, hint, section, segmented_row, setting_row, slider,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::correspondence::MatchSettings;
use crate::project::Project;
use crate::warp::WarpKind;

/// Initial maximum edge length of the mesh when the user turns off the automatic one, as a fraction
/// of the design's size.
const DEFAULT_EDGE_LENGTH: f64 = 0.05;

/// Draws the match section.
pub fn show(ui: &mut Ui, state: &UiState, draft: &mut Project, intents: &mut Intents) {
    // The warp by rigid parts has a mesh, even if its content is a distance field.
    let has_mesh =
        draft.warp == Some(WarpKind::Arap) && draft.content != Some(ContentKind::Colours);
    section(ui, "Match", |ui| {
        if draft.content != Some(ContentKind::Colours) {
            rules(ui, &mut draft.options.matching);
        }
        if draft.warp == Some(WarpKind::Arap) && draft.content == Some(ContentKind::Solid) {
            let tip = "How many matches are tried: only the first, or several.";
            setting_row(ui, "Quality", tip, &mut draft.options.quality);
            let tip = "Adjusts the motion where the film would fold or its outlines would meet. \
                       Applies to the best film only; the draft is shown at once.";
            setting_row(ui, "Avoid collisions", tip, &mut draft.options.guard);
        }
        if has_mesh {
            density(ui, &mut draft.options.triangulation.edge_length);
        }
        ui.add_space(4.0);
        hint(ui, &summary(&draft.options.matching));
        ui.horizontal(|ui| {
            let (name, tip) = if state.editor.is_open {
                ("Return to stage", "Keeps the match (E or Esc).")
            } else {
                (
                    "Edit match",
                    "Shows source and target side by side, to pair their points, lines and parts \
                     (E).",
                )
            };
            if ui.button(name).on_hover_text(tip).clicked() {
                intents.push(Intent::Editor(EditorAction::Toggle));
            }
            let tip = "Deletes all pins, lines, pairs and cuts set by hand. Can be undone.";
            if has_manual_entries(&draft.options.matching)
                && ui.button("Clear").on_hover_text(tip).clicked()
            {
                intents.push(Intent::Editor(EditorAction::Clear));
            }
        });
    });
}

fn rules(ui: &mut Ui, matching: &mut MatchSettings) {
    let tip = "Whether a shape may match a rotated one.";
    let rotations = [
        (false, "Free", "Shapes match in any rotation"),
        (true, "Keep upright", "Up stays up, as it must for letters"),
    ];
    segmented_row(ui, "Rotation", tip, &mut matching.keep_up, &rotations);
    let tip = "How to treat a hole that exists in only one design.";
    setting_row(ui, "Holes", tip, &mut matching.holes);
    let tip = "How to treat a part that exists in only one design.";
    setting_row(ui, "Parts", tip, &mut matching.parts);
}

fn density(ui: &mut Ui, edge_length: &mut Option<f64>) {
    let tip = "Makes triangles as coarse as good angles allow. Off: set the edge length yourself.";
    automatic_toggle(ui, "Auto mesh", tip, edge_length, DEFAULT_EDGE_LENGTH);
    if let Some(length) = edge_length {
        let tip = "Maximum edge length inside, as a fraction of the design's size. Smaller values \
                   give more triangles, softer bends and slower frames.";
        slider(ui, "Edge length", tip, length, 0.01..=0.25, true);
    }
}

fn has_manual_entries(matching: &MatchSettings) -> bool {
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

fn summary(matching: &MatchSettings) -> String {
    if !has_manual_entries(matching) {
        return "Nothing set by hand yet. Outlines match automatically; pictures need pins or \
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
        count(matching.lone.len(), "unmatched part", "unmatched parts"),
        count(matching.cuts.len(), "cut", "cuts"),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    format!("Set by hand: {}.", all.join(", "))
}
