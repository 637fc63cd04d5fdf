//! How parts move: the options of the rigidity-preserving interpolation.

use std::ops::RangeInclusive;

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::theme::CONTROL_HEIGHT;
use crate::app::ui::kit::widgets::{choice_list, choices, drag, number, row, section, toggle};
use crate::app::ui::ui_state::UiState;
use crate::warp::{ArapOptions, ArapPath, FaceWeights};

/// The most parts that get a number of their own; more would fill the window.
const MOST_PARTS: usize = 8;

/// The most times that faces are split in the window: each makes four of one.
const MOST_SUBDIVISIONS: u32 = 4;

/// Whole turns that the window offers: no film can be followed that turns more.
const TURNS: RangeInclusive<i32> = -9..=9;

/// Draws the options.
pub fn show(ui: &mut Ui, scene: &UiState, arap: &mut ArapOptions) {
    section(ui, "Motion of parts", |ui| {
        let tip = "How each triangle goes from its first form to its last (the homotopy).";
        choice_list(ui, "Triangles", tip, &mut arap.homotopy);
        weights(ui, &mut arap.weights);
        let tip = "On: the film from target to source is the same backwards. Off: only the source's \
             triangles count, as in the paper.";
        toggle(ui, "Symmetric", tip, &mut arap.symmetric);
        path(ui, &mut arap.path);
        extra_turns(ui, &mut arap.extra_turns, scene.session.parts());
        let subdivisions = drag(&mut arap.subdivisions, 0..=MOST_SUBDIVISIONS, 0.02, 0);
        let tip = "Splits each triangle into four, so many times: parts bend more softly, frames take longer.";
        number(ui, "Subdivide", tip, subdivisions);
    });
}

fn weights(ui: &mut Ui, weights: &mut FaceWeights) {
    let tip = "How much each triangle has to say. Stiffer where the weight is larger.";
    row(ui, "Weights", tip, |ui| {
        let mut options = vec![
            (
                FaceWeights::Area,
                "Area",
                "By area: fine triangles do not stiffen the shape",
            ),
            (
                FaceWeights::Uniform,
                "Uniform",
                "All alike, as in the paper: finely divided parts are stiffer",
            ),
        ];
        // Numbers of one's own cannot be written here, but must not be lost by a click either.
        if matches!(weights, FaceWeights::PerFace(_)) {
            options.push((
                weights.clone(),
                "Own",
                "The numbers that stand in the project file",
            ));
        }
        choices(ui, weights, &options)
    });
}

fn path(ui: &mut Ui, path: &mut ArapPath) {
    let tip = "How the whole gets from its first place to its last: which of its points goes straight, \
               or about which point it turns.";
    row(ui, "Path", tip, |ui| {
        let (anchor, width) = match *path {
            // Room beside the three for the number of the vertex.
            ArapPath::Anchor(vertex) => (vertex, 128.0),
            ArapPath::Centroid | ArapPath::Pole => (0, ui.available_width()),
        };
        let anchor = ArapPath::Anchor(anchor);
        let options = [
            (
                ArapPath::Centroid,
                "Centre",
                "The centre of mass goes straight",
            ),
            (
                ArapPath::Pole,
                "Arc",
                "The whole turns about its pole, the one point that stays where it is: it swings \
                 instead of sliding",
            ),
            (anchor, "Vertex", "One vertex goes straight, by its number"),
        ];
        let chosen = ui.scope(|ui| {
            ui.set_max_width(width);
            choices(ui, path, &options)
        });
        let ArapPath::Anchor(vertex) = path else {
            return chosen.inner;
        };
        chosen.inner | ui.add_sized([56.0, CONTROL_HEIGHT], DragValue::new(vertex).prefix("# "))
    });
}

fn extra_turns(ui: &mut Ui, turns: &mut Vec<i32>, parts: usize) {
    let tip = "Whole turns that are added on the way: the ends stay, the film goes round. Negative: clockwise.";
    let each = turns.len() > 1;
    let first = turns.first().copied().unwrap_or(0);
    if each {
        for (part, turn) in turns.iter_mut().enumerate().take(MOST_PARTS) {
            let label = format!("Turns, part {}", part + 1);
            number(ui, &label, tip, drag(turn, TURNS, 0.02, 0));
        }
    } else {
        let mut all = first;
        number(ui, "Extra turns", tip, drag(&mut all, TURNS, 0.02, 0));
        if all != first {
            *turns = if all == 0 { Vec::new() } else { vec![all] };
        }
    }
    if parts > 1 && parts <= MOST_PARTS {
        let mut apart = each;
        let tip = "A number of turns of its own for each part that hangs on others by points only.";
        toggle(ui, "Each part", tip, &mut apart);
        if apart != each {
            let all = turns.first().copied().unwrap_or(0);
            *turns = if apart { vec![all; parts] } else { vec![all] };
        }
    }
}
