//! How pins bend a grid of splines.

use bevy_egui::egui::{DragValue, Ui};

use crate::app::ui::kit::widgets::{number, section, toggle};
use crate::warp::LatticeOptions;

/// The coarsest lattice is offered up to so many cells, and levels up to so
/// many: the finest then has 1,024 cells, the most there may be.
const MOST_CELLS: u32 = 16;
const MOST_LEVELS: u32 = 7;

/// Draws the options.
pub fn show(ui: &mut Ui, lattice: &mut LatticeOptions) {
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
