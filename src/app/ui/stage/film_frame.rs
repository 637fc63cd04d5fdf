//! Frame of the exported film: a rectangle on the stage around the section of the plane that the
//! export shows. It is drawn while the export settings are open.

use bevy_egui::egui::{Color32, Rect, Stroke, StrokeKind, Ui, vec2};

use crate::app::ui::kit::theme::ThemePalette;
use crate::app::ui::stage::area::is_light;
use crate::app::ui::ui_state::UiState;

/// Opacity of the shade outside the rectangle, out of 255 (heuristic).
const SHADE: u8 = 40;

/// Draws the rectangle that the export shows, and shades the stage outside it.
pub fn frame(ui: &Ui, state: &UiState, stage: Rect) {
    let Some(framed) = &state.film_framing.0 else {
        return;
    };
    let bounds = framed.bounds();
    let at = |p| {
        let px = state.view.px_from_world(p);
        stage.min + vec2(px.x, px.y)
    };
    let inside = Rect::from_two_pos(at(bounds.min), at(bounds.max));
    let painter = ui.painter().with_clip_rect(stage);
    let shade = Color32::from_black_alpha(SHADE);
    let (above, below) = stage.split_top_bottom_at_y(inside.top());
    let (middle_row, below_frame) = below.split_top_bottom_at_y(inside.bottom());
    let (left, right_of_left_edge) = middle_row.split_left_right_at_x(inside.left());
    let (_, right) = right_of_left_edge.split_left_right_at_x(inside.right());
    for shaded in [above, below_frame, left, right] {
        if shaded.is_positive() {
            painter.rect_filled(shaded, 0.0, shade);
        }
    }
    let ink = ThemePalette::on(is_light(state.session.style().ground)).accent;
    painter.rect_stroke(inside, 0.0, Stroke::new(1.0, ink), StrokeKind::Inside);
}
