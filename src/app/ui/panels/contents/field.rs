//! How distance fields are made and blended.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{list, number, pick, section, slider};
use crate::content::{BlendSpace, FieldBlend};
use crate::field::Metric;
use crate::transition::{Boundary, FieldOptions};

/// Draws the options.
pub fn show(ui: &mut Ui, field: &mut FieldOptions) {
    section(ui, "Distance field", |ui| {
        mixing(ui, &mut field.blend);
        list(
            ui,
            "Metric",
            "What distance means; it shows in the corners.",
            &mut field.metric,
        );
        let is_euclidean = field.metric == Metric::Euclidean;
        ui.add_enabled_ui(is_euclidean, |ui| outline(ui, &mut field.boundary));
        let cells = DragValue::new(&mut field.cells).range(32..=4096).speed(4.0);
        number(
            ui,
            "Cells",
            "Cells along the longer side. More: finer detail, and ε and threshold mean smaller distances.",
            cells,
        );
        slider(
            ui,
            "Margin",
            "Room around the designs, as a part of the longer side. Needed where the shape grows outwards.",
            &mut field.margin,
            0.0..=1.0,
            false,
        );
    });
}

/// How the two fields become one.
fn mixing(ui: &mut Ui, blend: &mut FieldBlend) {
    pick(
        ui,
        "Space",
        "The scale on which distances are mixed.",
        &mut blend.space,
    );
    ui.add_enabled_ui(blend.space == BlendSpace::Log, |ui| {
        slider(
            ui,
            "ε",
            "How sharply the logarithm prefers what is near, in cells. Small: the two outlines \
             stay visible as a web; large: like real space. Only for logarithmic space.",
            &mut blend.epsilon,
            0.01..=100.0,
            true,
        );
    });
    slider(
        ui,
        "Threshold",
        "The distance that is drawn as the outline, in cells. Above 0 the shape grows thinner, below 0 thicker.",
        &mut blend.threshold,
        -40.0..=40.0,
        false,
    );
}

fn outline(ui: &mut Ui, boundary: &mut Boundary) {
    pick(
        ui,
        "Outline",
        "Where the edge of a shape lies within a cell; metrics other than the Euclidean have it \
         between cells.",
        boundary,
    );
}
