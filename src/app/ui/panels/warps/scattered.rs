//! How pins pull the plane along.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{list, number, section};
use crate::warp::{Basis, ScatteredOptions};

/// Draws the options.
pub fn show(ui: &mut Ui, scattered: &mut ScatteredOptions) {
    section(ui, "Points", |ui| {
        let tip = "How the pull of a pin spreads.";
        list(ui, "Basis", tip, &mut scattered.basis);
        match scattered.basis {
            Basis::ThinPlate => {}
            Basis::Gaussian => {
                let width = DragValue::new(&mut scattered.width)
                    .range(0.005..=1.0)
                    .speed(0.002)
                    .fixed_decimals(3);
                let tip = "How far a pin reaches, in diagonals of the frame.";
                number(ui, "Width", tip, width);
            }
            Basis::Multiquadric => {
                let exponent = DragValue::new(&mut scattered.exponent)
                    .range(0.1..=0.95)
                    .speed(0.01)
                    .fixed_decimals(2);
                number(ui, "Exponent", "Small is tight, large is wide.", exponent);
            }
        }
        let smoothing = DragValue::new(&mut scattered.smoothing)
            .range(0.0..=10.0)
            .speed(0.001)
            .fixed_decimals(3);
        let tip = "How much pins may be missed for a smoother warp. 0 meets each of them.";
        number(ui, "Smoothing", tip, smoothing);
    });
}
