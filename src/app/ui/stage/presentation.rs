//! What an audience sees besides the drawing: captions, or black.

use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::export::Captions;

/// Draws it, and returns the part of the window that is left to the drawing.
pub fn show(root: &Ui, scene: &UiState, whole: Rect, acts: &mut Intents) -> Rect {
    let hand = root.interact(whole, root.id().with("talk"), Sense::click());
    if hand.clicked() {
        acts.push(Intent::PlayToNextStop);
    }
    if hand.secondary_clicked() {
        acts.push(Intent::PlayToPreviousStop);
    }
    let mut stage = whole;
    if let Some(captions) = scene.presenting.captions(&scene.session) {
        let band = Captions::BAND as f32 * whole.size().min_elem();
        stage.max.y -= band;
        if let Some((words, seen)) = captions.at(scene.playback.t()) {
            let [r, g, b] = captions.colour().0;
            let ink = Color32::from_rgb(r, g, b).gamma_multiply(seen as f32);
            caption(root, words, whole, ink);
        }
    }
    if scene.presenting.is_black() {
        root.painter().rect_filled(whole, 0.0, Color32::BLACK);
    }
    stage
}

/// One line in the middle below, as large as in films.
fn caption(root: &Ui, words: &str, whole: Rect, ink: Color32) {
    let shorter = whole.size().min_elem();
    let laid = |height: f32| {
        let font = FontId::proportional(height);
        root.painter().layout_no_wrap(words.to_owned(), font, ink)
    };
    let height = Captions::LETTERS as f32 * shorter;
    let mut line = laid(height);
    let widest = Captions::WIDEST as f32 * whole.width();
    if line.size().x > widest {
        line = laid(height * widest / line.size().x);
    }
    let middle = whole.center_bottom() - vec2(0.0, 0.5 * Captions::BAND as f32 * shorter);
    let place = Align2::CENTER_CENTER.anchor_size(middle, line.size());
    root.painter().galley(place.min, line, ink);
}
