//! Presentation: captions over the drawing, or a black screen.

use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::export::Captions;

/// Draws captions or black and handles clicks; returns the rectangle left for the drawing.
pub fn show(root: &Ui, state: &UiState, whole: Rect, intents: &mut Intents) -> Rect {
    let hand = root.interact(whole, root.id().with("talk"), Sense::click());
    if hand.clicked() {
        intents.push(Intent::PlayToNextStop);
    }
    if hand.secondary_clicked() {
        intents.push(Intent::PlayToPreviousStop);
    }
    let mut stage = whole;
    if let Some(captions) = state.presenting.captions(&state.session) {
        let band = Captions::BAND as f32 * whole.size().min_elem();
        stage.max.y -= band;
        if let Some((words, opacity)) = captions.at(state.playback.t()) {
            let [r, g, b] = captions.colour().0;
            let ink = Color32::from_rgb(r, g, b).gamma_multiply(opacity as f32);
            caption(root, words, whole, ink);
        }
    }
    if state.presenting.is_black() {
        root.painter().rect_filled(whole, 0.0, Color32::BLACK);
    }
    stage
}

/// Draws one line centred at the bottom, as large as in exported films.
fn caption(root: &Ui, words: &str, whole: Rect, ink: Color32) {
    let shorter = whole.size().min_elem();
    let layout = |height: f32| {
        let font = FontId::proportional(height);
        root.painter().layout_no_wrap(words.to_owned(), font, ink)
    };
    let height = Captions::LETTERS as f32 * shorter;
    let mut line = layout(height);
    let max_width = Captions::WIDEST as f32 * whole.width();
    if line.size().x > max_width {
        line = layout(height * max_width / line.size().x);
    }
    let middle = whole.center_bottom() - vec2(0.0, 0.5 * Captions::BAND as f32 * shorter);
    let place = Align2::CENTER_CENTER.anchor_size(middle, line.size());
    root.painter().galley(place.min, line, ink);
}
