//! Sections of the inspector with the options of the content: the cross-fade of pictures, and
//! distance fields.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{
    drag_value, number, section, setting_menu_row, setting_row, slider,
};
use crate::content::{BlendSpace, ColourMix, FieldBlend};
use crate::field::Metric;
use crate::transition::FieldOptions;

/// Minimum length of the range of t in which the pictures cross-fade (tolerance: a range without
/// length would be a jump).
const MIN_RANGE: f64 = 0.01;

/// Draws the section with the options of the cross-fade between two pictures.
pub fn colours(ui: &mut Ui, mix: &mut ColourMix) {
    section(ui, "Colours", |ui| {
        let tip = "How fast one picture fades into the other.";
        setting_menu_row(ui, "Curve", tip, &mut mix.curve);
        // The limits keep the two ends of the range at least `MIN_RANGE` apart.
        let from = drag_value(&mut mix.from, 0.0..=mix.to - MIN_RANGE, 0.005, 2);
        number(
            ui,
            "From t",
            "Before this moment only the source is visible.",
            from,
        );
        let to = drag_value(&mut mix.to, mix.from + MIN_RANGE..=1.0, 0.005, 2);
        number(
            ui,
            "To t",
            "After this moment only the target is visible.",
            to,
        );
    });
}

/// Draws the section with the options of distance fields and of their blending.
pub fn field(ui: &mut Ui, field: &mut FieldOptions) {
    section(ui, "Distance field", |ui| {
        blending(ui, &mut field.blend);
        let tip = "How distance is measured. The difference shows at corners.";
        setting_menu_row(ui, "Distance", tip, &mut field.metric);
        // Other metrics count whole cells, so the option (the outline's position within a cell)
        // applies only to the Euclidean metric.
        let is_euclidean = field.metric == Metric::Euclidean;
        let tip = "Position of the outline within a cell. Metrics other than Euclidean place it \
                   between cells.";
        ui.add_enabled_ui(is_euclidean, |ui| {
            setting_row(ui, "Outline", tip, &mut field.boundary)
        });
        let cells = drag_value(&mut field.cells, 32..=4096, 4.0, 0);
        let tip = "Number of cells along the longer side. More cells give finer detail; softness \
                   and threshold then mean smaller distances.";
        number(ui, "Cells", tip, cells);
        let tip = "Space around the designs, as a fraction of the longer side. Needed where the \
                   shape grows outwards.";
        slider(ui, "Margin", tip, &mut field.margin, 0.0..=1.0, false);
    });
}

/// Draws the options of the blend of two distance fields.
fn blending(ui: &mut Ui, blend: &mut FieldBlend) {
    let tip = "Scale on which distances are blended.";
    setting_row(ui, "Scale", tip, &mut blend.space);
    ui.add_enabled_ui(blend.space == BlendSpace::Log, |ui| {
        let tip = "How gently the logarithm favours points near the outlines, in cells. Small: \
                   both outlines stay visible as a web. Large: like a linear scale. Only for the \
                   logarithmic scale.";
        slider(
            ui,
            "Softness ε",
            tip,
            &mut blend.epsilon,
            0.01..=100.0,
            true,
        );
    });
    let tip = "Distance that is drawn as the outline, in cells. Positive values make the shape \
               thinner, negative values thicker.";
    let threshold = &mut blend.threshold;
    slider(ui, "Threshold", tip, threshold, -40.0..=40.0, false);
}
