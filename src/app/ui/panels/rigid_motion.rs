//! Rigid motion section of the inspector: options of the as-rigid-as-possible interpolation.

use std::ops::RangeInclusive;

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::theme::CONTROL_HEIGHT;
use crate::app::ui::kit::widgets::{
    drag_value, number, row, section, segmented_control, setting_menu_row, toggle,
};
use crate::app::ui::ui_state::UiState;
use crate::warp::{ArapOptions, ArapPath, FaceWeights};

/// Maximum number of parts for which the user can set extra full turns separately (resource limit:
/// room in the panel).
const MAX_PARTS: usize = 8;

/// Maximum number of subdivisions that the window offers (resource limit: each subdivision
/// quadruples the number of faces).
const MAX_SUBDIVISIONS: u32 = 4;

/// Range of extra full turns that can be set in the window. The eye cannot follow faster rotation.
const TURN_RANGE: RangeInclusive<i32> = -9..=9;

/// Draws the rigid motion section.
pub fn show(ui: &mut Ui, state: &UiState, arap: &mut ArapOptions) {
    section(ui, "Rigid motion", |ui| {
        let tip = "How each triangle is interpolated from source to target (homotopy).";
        setting_menu_row(ui, "Interpolation", tip, &mut arap.homotopy);
        weights(ui, &mut arap.weights);
        let tip = "On: swapping source and target gives the same film backwards. Off: only the \
                   source's triangles count, as in the paper.";
        toggle(ui, "Symmetric", tip, &mut arap.symmetric);
        path(ui, &mut arap.path);
        extra_turns(ui, &mut arap.extra_turns, state.session.parts());
        let subdivisions = drag_value(&mut arap.subdivisions, 0..=MAX_SUBDIVISIONS, 0.02, 0);
        let tip = "Splits each triangle into four, this many times. Parts bend more softly, frames \
                   take longer.";
        number(ui, "Subdivide", tip, subdivisions);
    });
}

fn weights(ui: &mut Ui, weights: &mut FaceWeights) {
    let tip = "Weight of each triangle. Heavier triangles stay more rigid.";
    row(ui, "Weights", tip, |ui| {
        let mut options = vec![
            (
                FaceWeights::Area,
                "Area",
                "By area: small triangles do not stiffen the shape",
            ),
            (
                FaceWeights::Uniform,
                "Uniform",
                "All equal, as in the paper: finely divided parts are stiffer",
            ),
        ];
        // Weights of single faces come from the project file. They cannot be edited in the window,
        // but they are listed as a choice while they are in use.
        if matches!(weights, FaceWeights::PerFace(_)) {
            options.push((weights.clone(), "Custom", "The weights in the project file"));
        }
        segmented_control(ui, weights, &options)
    });
}

fn path(ui: &mut Ui, path: &mut ArapPath) {
    let tip = "How the shape as a whole moves: one of its points goes straight, or the shape \
               rotates about a fixed point.";
    row(ui, "Path", tip, |ui| {
        let (anchor, width) = match *path {
            // The choices are narrower than the row, which leaves room for the vertex number.
            ArapPath::Anchor(vertex) => (vertex, 128.0),
            ArapPath::Centroid | ArapPath::Pole => (0, ui.available_width()),
        };
        let anchor = ArapPath::Anchor(anchor);
        let options = [
            (
                ArapPath::Centroid,
                "Centre",
                "The centre of mass moves straight",
            ),
            (
                ArapPath::Pole,
                "Arc",
                "The shape rotates about its pole, the one point that stays in place",
            ),
            (
                anchor,
                "Vertex",
                "The vertex with this number moves straight",
            ),
        ];
        let chosen = ui.scope(|ui| {
            ui.set_max_width(width);
            segmented_control(ui, path, &options)
        });
        let ArapPath::Anchor(vertex) = path else {
            return chosen.inner;
        };
        chosen.inner | ui.add_sized([56.0, CONTROL_HEIGHT], DragValue::new(vertex).prefix("# "))
    });
}

fn extra_turns(ui: &mut Ui, turns: &mut Vec<i32>, parts: usize) {
    let tip = "Full turns added to the motion; source and target stay the same. Negative: \
               clockwise.";
    let is_per_part = turns.len() > 1;
    let first = turns.first().copied().unwrap_or(0);
    if is_per_part {
        for (part, turn) in turns.iter_mut().enumerate().take(MAX_PARTS) {
            let label = format!("Turns, part {}", part + 1);
            number(ui, &label, tip, drag_value(turn, TURN_RANGE, 0.02, 0));
        }
    } else {
        let mut all = first;
        number(
            ui,
            "Extra turns",
            tip,
            drag_value(&mut all, TURN_RANGE, 0.02, 0),
        );
        if all != first {
            *turns = if all == 0 { Vec::new() } else { vec![all] };
        }
    }
    if parts > 1 && parts <= MAX_PARTS {
        let mut per_part = is_per_part;
        let tip = "Sets the turns of each part separately, for parts connected only at points.";
        toggle(ui, "Per part", tip, &mut per_part);
        if per_part != is_per_part {
            let all = turns.first().copied().unwrap_or(0);
            *turns = if per_part {
                vec![all; parts]
            } else {
                vec![all]
            };
        }
    }
}
