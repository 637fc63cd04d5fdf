//! The options of how it moves: of all warps but rigid parts.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{list, number, pick, section, toggle};
use crate::warp::{Basis, LatticeOptions, LineOptions, PathOptions, ScatteredOptions, Travel};

/// The coarsest lattice is offered up to so many cells, and levels up to so
/// many: the finest then has 1,024 cells, the most there may be.
const MOST_CELLS: u32 = 16;
const MOST_LEVELS: u32 = 7;

/// How pins and lines travel from the source to the target.
pub fn travel(ui: &mut Ui, travel: &mut Travel) {
    section(ui, "Features", |ui| {
        list(ui, "Travel", "How pins and lines get there.", travel);
    });
}

/// On which paths the points of an outline move.
pub fn paths(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        let tip = "How each point of the outline moves.";
        pick(ui, "Course", tip, &mut paths.course);
    });
}

/// How pairs of lines pull the plane along.
pub fn lines(ui: &mut Ui, lines: &mut LineOptions) {
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

/// How pins pull the plane along.
pub fn scattered(ui: &mut Ui, scattered: &mut ScatteredOptions) {
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

/// How pins bend a grid of splines.
pub fn lattice(ui: &mut Ui, lattice: &mut LatticeOptions) {
    section(ui, "Lattice", |ui| {
        let tip = "On: the plane never folds, and a pin that cannot be reached is missed. Off: pins \
             are met, and the plane may fold.";
        toggle(ui, "Fold-free", tip, &mut lattice.fold_free);
        let coarsest = DragValue::new(&mut lattice.coarsest)
            .range(1..=MOST_CELLS)
            .speed(0.05);
        let tip = "Cells of the first lattice. Fewer move more of the plane with a pin.";
        number(ui, "Coarsest", tip, coarsest);
        let levels = DragValue::new(&mut lattice.levels)
            .range(1..=MOST_LEVELS)
            .speed(0.05);
        let tip = "How many lattices, each twice as fine as the one before.";
        number(ui, "Levels", tip, levels);
    });
}
