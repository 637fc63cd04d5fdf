//! One line of the strip with the results of the check, below the stage.

use bevy_egui::egui::{Sense, Ui, vec2};

use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::ThemePalette;

/// Height of one line of the strip, in points.
pub const ROW_HEIGHT: f32 = 24.0;

/// Draws a line with a tick, or with a warning sign if `is_clear` is false.
pub fn row(ui: &mut Ui, is_clear: bool, content: impl FnOnce(&mut Ui)) {
    let palette = ThemePalette::of(ui);
    let (icon, colour) = if is_clear {
        (icons::TICK, palette.good)
    } else {
        (icons::WARNING, palette.amber)
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.set_min_height(ROW_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(vec2(16.0, 20.0), Sense::hover());
        icons::paint_icon(ui.painter(), icon, rect, colour);
        content(ui);
    });
}
