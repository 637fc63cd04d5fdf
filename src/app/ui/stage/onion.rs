//! Onion skins: thin outlines of the film at its stops, or at regular t, drawn over the stage.

use bevy_egui::egui::{Color32, Pos2, Rect, Shape, Stroke, Ui, vec2};

use crate::app::ui::ui_state::UiState;
use crate::geometry::DVec2;
use crate::transition::colour_fraction;

/// Opacity of an onion skin, from 0 to 1 (heuristic).
const OPACITY: f32 = 0.55;

/// Draws the onion skins. Each has the fill colour that the film has at the t of the skin.
pub fn show(ui: &Ui, state: &UiState, stage: Rect) {
    let painter = ui.painter().with_clip_rect(stage);
    let style = state.session.style();
    let layout = state.session.sequence_layout();
    let at = |p: &DVec2| -> Pos2 {
        let px = state.view.px_from_world(*p);
        stage.min + vec2(px.x, px.y)
    };
    for skin in state.onion.skins() {
        let [r, g, b] = style.fill_at(colour_fraction(skin.t, layout)).0;
        let ink = Color32::from_rgb(r, g, b).gamma_multiply(OPACITY);
        let stroke = Stroke::new(1.0, ink);
        for ring in &skin.rings {
            painter.add(Shape::closed_line(ring.iter().map(at).collect(), stroke));
        }
        for [a, b] in &skin.bars {
            painter.line_segment([at(a), at(b)], stroke);
        }
    }
}
