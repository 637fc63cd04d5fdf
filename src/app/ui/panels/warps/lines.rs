//! How pairs of lines pull the plane along.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{number, pick, section};
use crate::warp::LineOptions;

/// Draws the options.
pub fn show(ui: &mut Ui, lines: &mut LineOptions) {
    section(ui, "Lines", |ui| {
        let tip = "How a line lies between its two.";
        pick(ui, "Between", tip, &mut lines.between);
        let smoothness = DragValue::new(&mut lines.smoothness)
            .range(1e-4..=1.0)
            .speed(0.001)
            .fixed_decimals(3);
        let tip = "How near a line is followed, in diagonals of the frame. Small follows to the \
                   pixel, large is smooth.";
        number(ui, "Smoothness", tip, smoothness);
        let falloff = DragValue::new(&mut lines.falloff)
            .range(0.1..=8.0)
            .speed(0.02)
            .fixed_decimals(2);
        let tip = "How fast a line's pull weakens with distance.";
        number(ui, "Falloff", tip, falloff);
        let exponent = DragValue::new(&mut lines.length_exponent)
            .range(0.0..=2.0)
            .speed(0.01)
            .fixed_decimals(2);
        let tip = "How much more long lines weigh: 0 not at all, 1 as their length.";
        number(ui, "Length counts", tip, exponent);
    });
}
