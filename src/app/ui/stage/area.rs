//! The part of the window that the stage shows through: it can be dragged and zoomed, and says
//! what to do while it is empty.

use bevy::prelude::Vec2;
use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::panels::appearance;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;

/// One line of the wheel zooms by this exponent; eight lines make a factor of about 2.7.
const ZOOM_PER_POINT: f32 = 0.0025;

/// Turns dragging and scrolling over the stage, or over what shows the same of the plane beside
/// it, into intents.
pub fn show(root: &mut Ui, rect: Rect, name: &str, acts: &mut Intents) {
    let response = root.interact(rect, root.id().with(name), Sense::click_and_drag());
    if response.dragged() {
        let delta = response.drag_delta();
        acts.push(Intent::Pan(Vec2::new(delta.x, delta.y)));
    }
    if response.double_clicked() {
        acts.push(Intent::FitView);
    }
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    if let Some(factor) = zoom_factor(root) {
        // From the corner of the part that it lies in: beside the stage the same of the plane is
        // seen.
        let at = pointer - rect.min;
        acts.push(Intent::Zoom {
            at: Vec2::new(at.x, at.y),
            factor,
        });
    }
}

/// Says what to do while there is nothing to see.
pub fn empty_hint(root: &Ui, scene: &UiState, rect: Rect) {
    if let Some(words) = empty_words(scene) {
        let ink = ink_on(scene.session.style().ground);
        let font = FontId::proportional(16.0);
        root.painter()
            .text(rect.center(), Align2::CENTER_CENTER, words, font, ink);
    }
}

/// By how much the hand zooms in this frame, by the wheel or by two fingers; nothing where it does
/// not.
pub fn zoom_factor(ui: &Ui) -> Option<f32> {
    let factor = ui
        .input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * ZOOM_PER_POINT).exp());
    (factor != 1.0).then_some(factor)
}

fn empty_words(scene: &UiState) -> Option<&'static str> {
    let session = &scene.session;
    if session.work().is_some() {
        return None;
    }
    if session.transition().is_none() {
        return Some(match session.project() {
            None => "Choose a project from the gallery, or drop one or two files here.",
            Some(_) => "Nothing to show yet: choose another method, or other designs.",
        });
    }
    appearance::is_blank(scene).then_some("Everything is hidden: show the fill under Appearance.")
}

/// A ground is light where more than 18 % of the light comes back: a middle grey to the eye.
pub fn is_light(ground: Rgb) -> bool {
    let [r, g, b] = ground.to_linear();
    // Relative luminance, after WCAG 2.2.
    0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18
}

/// A quiet ink that can be read on a ground.
pub fn ink_on(ground: Rgb) -> Color32 {
    if is_light(ground) {
        Color32::from_gray(0x50)
    } else {
        Color32::from_gray(0xc8)
    }
}
