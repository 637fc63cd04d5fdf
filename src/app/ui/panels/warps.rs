//! The options of how it moves: of all warps but rigid parts.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{choice_list, choice_row, drag, number, section, toggle};
use crate::warp::{
    FeatureTravel, LatticeOptions, LineOptions, PathOptions, RadialBasis, ScatteredOptions,
};

/// The coarsest lattice is offered up to so many cells, and levels up to so
/// many: the finest then has 1,024 cells, the most there may be.
const MOST_CELLS: u32 = 16;
const MOST_LEVELS: u32 = 7;

/// How pins and lines travel from the source to the target.
pub fn travel(ui: &mut Ui, travel: &mut FeatureTravel) {
    section(ui, "Features", |ui| {
        choice_list(
            ui,
            "On the way",
            "How pins and lines get there (their travel).",
            travel,
        );
    });
}

/// On which paths the points of an outline move.
pub fn paths(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        let tip = "How each point of the outline moves.";
        choice_row(ui, "Course", tip, &mut paths.course);
    });
}

/// How pairs of lines pull the plane along.
pub fn lines(ui: &mut Ui, lines: &mut LineOptions) {
    section(ui, "Lines", |ui| {
        let tip = "How a line lies between its two.";
        choice_row(ui, "Between", tip, &mut lines.between);
        let smoothness = drag(&mut lines.smoothness, 1e-4..=1.0, 0.001, 3);
        let tip = "How near a line is followed, in diagonals of the frame. Small follows to the \
                   pixel, large is smooth.";
        number(ui, "Smoothness", tip, smoothness);
        let falloff = drag(&mut lines.falloff, 0.1..=8.0, 0.02, 2);
        let tip = "How fast a line's pull weakens with distance.";
        number(ui, "Falloff", tip, falloff);
        let exponent = drag(&mut lines.length_exponent, 0.0..=2.0, 0.01, 2);
        let tip = "How much more long lines weigh: 0 not at all, 1 as their length.";
        number(ui, "Length counts", tip, exponent);
    });
}

/// How pins pull the plane along.
pub fn scattered(ui: &mut Ui, scattered: &mut ScatteredOptions) {
    section(ui, "Points", |ui| {
        let tip = "How the pull of a pin spreads (the basis function).";
        choice_list(ui, "Pull", tip, &mut scattered.basis);
        match scattered.basis {
            RadialBasis::ThinPlate => {}
            RadialBasis::Gaussian => {
                let width = drag(&mut scattered.width, 0.005..=1.0, 0.002, 3);
                let tip = "How far a pin reaches, in diagonals of the frame.";
                number(ui, "Width", tip, width);
            }
            RadialBasis::Multiquadric => {
                let exponent = drag(&mut scattered.exponent, 0.1..=0.95, 0.01, 2);
                number(
                    ui,
                    "Spread",
                    "Small is tight, large is wide (the exponent).",
                    exponent,
                );
            }
        }
        let smoothing = drag(&mut scattered.smoothing, 0.0..=10.0, 0.001, 3);
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
        let coarsest = drag(&mut lattice.coarsest, 1..=MOST_CELLS, 0.05, 0);
        let tip = "Cells of the first lattice. Fewer move more of the plane with a pin.";
        number(ui, "First cells", tip, coarsest);
        let levels = drag(&mut lattice.levels, 1..=MOST_LEVELS, 0.05, 0);
        let tip = "How many lattices, each twice as fine as the one before.";
        number(ui, "Levels", tip, levels);
    });
}
