//! Presentation mode: captions below the drawing, the black screen, and clicks that play to the
//! next or previous stop.

use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::export::Captions;

/// Draws the caption or the black screen, and handles clicks. Returns the rectangle of the drawing.
pub fn show(root: &Ui, state: &UiState, full_rect: Rect, intents: &mut Intents) -> Rect {
    let response = root.interact(full_rect, root.id().with("talk"), Sense::click());
    if response.clicked() {
        intents.push(Intent::PlayToNextStop);
    }
    if response.secondary_clicked() {
        intents.push(Intent::PlayToPreviousStop);
    }
    let mut stage = full_rect;
    if let Some(captions) = state.presentation.captions(&state.session) {
        let band = Captions::BAND_HEIGHT as f32 * full_rect.size().min_elem();
        stage.max.y -= band;
        if let Some((text, opacity)) = captions.at(state.playback.t()) {
            let [r, g, b] = captions.colour().0;
            let ink = Color32::from_rgb(r, g, b).gamma_multiply(opacity as f32);
            caption(root, text, full_rect, ink);
        }
    }
    if state.presentation.is_black() {
        root.painter().rect_filled(full_rect, 0.0, Color32::BLACK);
    }
    stage
}

/// Draws a caption as one line, centred at the lower edge and as large as in exported films.
fn caption(root: &Ui, text: &str, full_rect: Rect, ink: Color32) {
    let shorter = full_rect.size().min_elem();
    let layout = |height: f32| {
        let font = FontId::proportional(height);
        root.painter().layout_no_wrap(text.to_owned(), font, ink)
    };
    let height = Captions::TEXT_HEIGHT as f32 * shorter;
    let mut line = layout(height);
    let max_width = Captions::MAX_WIDTH as f32 * full_rect.width();
    if line.size().x > max_width {
        line = layout(height * max_width / line.size().x);
    }
    let centre =
        full_rect.center_bottom() - vec2(0.0, 0.5 * Captions::BAND_HEIGHT as f32 * shorter);
    let place = Align2::CENTER_CENTER.anchor_size(centre, line.size());
    root.painter().galley(place.min, line, ink);
}
