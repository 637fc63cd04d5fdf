//! Stage area: the rectangle of the window in which the stage is visible. Handles panning and
//! zooming, shows a hint while the stage is empty, and provides colours that are readable on the
//! stage's background.

use bevy::prelude::Vec2;
use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::panels::appearance;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;

/// Natural logarithm of the zoom factor per point scrolled: eight lines of the wheel zoom by a
/// factor of about 2.7 (heuristic).
const ZOOM_PER_POINT: f32 = 0.0025;

/// Sends intents that pan, zoom and fit the view when the user drags, scrolls or double-clicks in
/// `rect`.
///
/// `rect` is the stage or the right half of a comparison, which shows the same section of the
/// plane.
pub fn show(root: &mut Ui, rect: Rect, name: &str, intents: &mut Intents) {
    let response = root.interact(rect, root.id().with(name), Sense::click_and_drag());
    if response.dragged() {
        let delta = response.drag_delta();
        intents.push(Intent::Pan(Vec2::new(delta.x, delta.y)));
    }
    if response.double_clicked() {
        intents.push(Intent::FitView);
    }
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    if let Some(factor) = zoom_factor(root) {
        // Both halves of a comparison show the same view, so the position is relative to the half
        // under the pointer.
        let at = pointer - rect.min;
        intents.push(Intent::Zoom {
            at: Vec2::new(at.x, at.y),
            factor,
        });
    }
}

/// Draws a hint in the middle of `rect` if the stage shows nothing.
pub fn empty_hint(root: &Ui, state: &UiState, rect: Rect) {
    if let Some(text) = empty_words(state) {
        let ink = ink_on(state.session.style().ground);
        let font = FontId::proportional(16.0);
        root.painter()
            .text(rect.center(), Align2::CENTER_CENTER, text, font, ink);
    }
}

/// Returns the factor by which the wheel or a pinch zooms in this frame; `None` without zooming.
pub fn zoom_factor(ui: &Ui) -> Option<f32> {
    let factor = ui
        .input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * ZOOM_PER_POINT).exp());
    (factor != 1.0).then_some(factor)
}

fn empty_words(state: &UiState) -> Option<&'static str> {
    let session = &state.session;
    if session.work().is_some() {
        return None;
    }
    if session.transition().is_none() {
        return Some(match session.project() {
            None => "Choose a project from the gallery, or drop two or more files here.",
            Some(_) => "Nothing to show. Choose another method or other designs.",
        });
    }
    appearance::is_blank(state).then_some("All layers are hidden. Turn on Fill under Appearance.")
}

/// Returns whether a background is light. The limit is a relative luminance of 0.18, that of the
/// grey that the eye sees as halfway between black and white.
pub fn is_light(ground: Rgb) -> bool {
    let [r, g, b] = ground.to_linear();
    // The weighted sum is the relative luminance (WCAG 2.2).
    0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18
}

/// Returns a grey that is readable on a background.
pub fn ink_on(ground: Rgb) -> Color32 {
    if is_light(ground) {
        Color32::from_gray(0x50)
    } else {
        Color32::from_gray(0xc8)
    }
}
