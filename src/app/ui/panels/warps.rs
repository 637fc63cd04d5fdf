//! Sections of the inspector with the options of all warps except the warp by rigid parts.

use bevy_egui::egui::Ui;

use crate::app::ui::kit::widgets::{
    drag_value, number, section, setting_menu_row, setting_row, toggle,
};
use crate::warp::{
    FeatureTravel, LatticeOptions, LineOptions, PathOptions, RadialBasis, ScatteredOptions,
};

/// Maximum number of cells of the coarsest B-spline lattice along the longer side of the frame
/// (resource limit: with [`MAX_LEVELS`] lattices, the finest one has 1,024 cells along this side).
const MAX_CELLS: u32 = 16;

/// Maximum number of lattices, each twice as fine as the one before (resource limit: see
/// [`MAX_CELLS`]).
const MAX_LEVELS: u32 = 7;

/// Draws the section with the option of how pins and lines move from source to target.
pub fn travel(ui: &mut Ui, travel: &mut FeatureTravel) {
    section(ui, "Pins and lines", |ui| {
        setting_menu_row(
            ui,
            "Motion",
            "How pins and lines move from source to target.",
            travel,
        );
    });
}

/// Draws the section with the option of how the points of an outline move.
pub fn paths(ui: &mut Ui, paths: &mut PathOptions) {
    section(ui, "Boundary paths", |ui| {
        let tip = "How each point of the outline moves.";
        setting_row(ui, "Motion", tip, &mut paths.course);
    });
}

/// Draws the section with the options of warps by pairs of lines.
pub fn lines(ui: &mut Ui, lines: &mut LineOptions) {
    section(ui, "Lines", |ui| {
        let tip = "How a line is interpolated between source and target.";
        setting_row(ui, "Interpolation", tip, &mut lines.between);
        let smoothness = drag_value(&mut lines.smoothness, 1e-4..=1.0, 0.001, 3);
        let tip = "How smoothly the plane follows the lines, in frame diagonals. Small values \
                   follow them to the pixel.";
        number(ui, "Smoothness", tip, smoothness);
        let falloff = drag_value(&mut lines.falloff, 0.1..=8.0, 0.02, 2);
        let tip = "How fast a line's influence decreases with distance.";
        number(ui, "Falloff", tip, falloff);
        let exponent = drag_value(&mut lines.length_exponent, 0.0..=2.0, 0.01, 2);
        let tip = "How much more long lines weigh. 0: not at all. 1: in proportion to length.";
        number(ui, "Length weight", tip, exponent);
    });
}

/// Draws the section with the options of warps by pins (radial basis functions).
pub fn scattered(ui: &mut Ui, scattered: &mut ScatteredOptions) {
    section(ui, "Points", |ui| {
        let tip = "How the influence of a pin spreads (basis function).";
        setting_menu_row(ui, "Influence", tip, &mut scattered.basis);
        match scattered.basis {
            RadialBasis::ThinPlate => {}
            RadialBasis::Gaussian => {
                let width = drag_value(&mut scattered.width, 0.005..=1.0, 0.002, 3);
                let tip = "How far a pin reaches, in frame diagonals.";
                number(ui, "Radius", tip, width);
            }
            RadialBasis::Multiquadric => {
                let exponent = drag_value(&mut scattered.exponent, 0.1..=0.95, 0.01, 2);
                number(
                    ui,
                    "Spread",
                    "Small values are tight, large ones wide (exponent).",
                    exponent,
                );
            }
        }
        let smoothing = drag_value(&mut scattered.smoothing, 0.0..=10.0, 0.001, 3);
        let tip = "How far pins may be missed for a smoother warp. 0 reaches every pin exactly.";
        number(ui, "Smoothing", tip, smoothing);
    });
}

/// Draws the section with the options of warps by B-spline lattices.
pub fn lattice(ui: &mut Ui, lattice: &mut LatticeOptions) {
    section(ui, "Lattice", |ui| {
        let tip = "On: the plane never folds, and pins that would fold it are not reached. Off: \
                   all pins are reached, and the plane may fold.";
        toggle(ui, "Fold-free", tip, &mut lattice.fold_free);
        let coarsest = drag_value(&mut lattice.coarsest, 1..=MAX_CELLS, 0.05, 0);
        let tip = "Cells of the coarsest lattice. With fewer cells a pin moves more of the plane.";
        number(ui, "Coarse cells", tip, coarsest);
        let levels = drag_value(&mut lattice.levels, 1..=MAX_LEVELS, 0.05, 0);
        let tip = "Number of lattices, each twice as fine as the one before.";
        number(ui, "Levels", tip, levels);
    });
}
