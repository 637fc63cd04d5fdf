//! How one picture fades into the other, apart from how they move.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{list, number, section};
use crate::content::ColourMix;

/// The shortest span in which colours change.
const SHORTEST: f64 = 0.01;

/// Draws the options.
pub fn show(ui: &mut Ui, mix: &mut ColourMix) {
    section(ui, "Colours", |ui| {
        let tip = "How fast one picture gives way to the other.";
        list(ui, "Curve", tip, &mut mix.curve);
        let from = DragValue::new(&mut mix.from)
            .range(0.0..=mix.to - SHORTEST)
            .speed(0.005)
            .fixed_decimals(2);
        number(ui, "From t", "Until here only the source is seen.", from);
        let to = DragValue::new(&mut mix.to)
            .range(mix.from + SHORTEST..=1.0)
            .speed(0.005)
            .fixed_decimals(2);
        number(ui, "To t", "From here on only the target is seen.", to);
    });
}
