//! The options of what is seen.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{choice_list, choice_row, drag, number, section, slider};
use crate::content::{BlendSpace, ColourMix, FieldBlend};
use crate::field::Metric;
use crate::transition::FieldOptions;

/// The shortest span in which colours change.
const SHORTEST: f64 = 0.01;

/// How one picture fades into the other, apart from how they move.
pub fn colours(ui: &mut Ui, mix: &mut ColourMix) {
    section(ui, "Colours", |ui| {
        let tip = "How fast one picture gives way to the other.";
        choice_list(ui, "Curve", tip, &mut mix.curve);
        // The bounds keep the two apart: a span of no length would be a jump.
        let from = drag(&mut mix.from, 0.0..=mix.to - SHORTEST, 0.005, 2);
        number(ui, "From t", "Until here only the source is seen.", from);
        let to = drag(&mut mix.to, mix.from + SHORTEST..=1.0, 0.005, 2);
        number(ui, "To t", "From here on only the target is seen.", to);
    });
}

/// How distance fields are made and blended.
pub fn field(ui: &mut Ui, field: &mut FieldOptions) {
    section(ui, "Distance field", |ui| {
        mixing(ui, &mut field.blend);
        let tip = "What distance means; it shows in the corners.";
        choice_list(ui, "Distance", tip, &mut field.metric);
        // Other metrics are made from cells and know no place within one.
        let is_euclidean = field.metric == Metric::Euclidean;
        let tip = "Where the edge of a shape lies within a cell; metrics other than the Euclidean have \
             it between cells.";
        ui.add_enabled_ui(is_euclidean, |ui| {
            choice_row(ui, "Outline", tip, &mut field.boundary)
        });
        let cells = drag(&mut field.cells, 32..=4096, 4.0, 0);
        let tip = "Cells along the longer side. More: finer detail, and ε and threshold mean smaller distances.";
        number(ui, "Cells", tip, cells);
        let tip = "Room around the designs, as a part of the longer side. Needed where the shape grows outwards.";
        slider(ui, "Margin", tip, &mut field.margin, 0.0..=1.0, false);
    });
}

/// How the two fields become one.
fn mixing(ui: &mut Ui, blend: &mut FieldBlend) {
    let tip = "The scale on which distances are mixed.";
    choice_row(ui, "Space", tip, &mut blend.space);
    ui.add_enabled_ui(blend.space == BlendSpace::Log, |ui| {
        let tip = "How sharply the logarithm prefers what is near, in cells. Small: the two outlines \
             stay visible as a web; large: like real space. Only for logarithmic space.";
        slider(ui, "Softness ε", tip, &mut blend.epsilon, 0.01..=100.0, true);
    });
    let tip = "The distance that is drawn as the outline, in cells. Above 0 the shape grows thinner, below 0 thicker.";
    let threshold = &mut blend.threshold;
    slider(ui, "Threshold", tip, threshold, -40.0..=40.0, false);
}
