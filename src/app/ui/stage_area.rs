//! The part of the window that the stage shows through: it can be dragged and zoomed.

use bevy::prelude::Vec2;
use bevy_egui::egui::{Rect, Sense, Ui};

use super::Intents;
use crate::app::intent::Intent;

/// One line of the wheel zooms by this exponent; eight lines make a factor of about 2.7.
const ZOOM_PER_POINT: f32 = 0.0025;

/// Turns dragging and scrolling over the stage into intents.
pub fn show(root: &mut Ui, rect: Rect, acts: &mut Intents) {
    let response = root.interact(rect, root.id().with("stage"), Sense::click_and_drag());
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
    let factor = root
        .input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * ZOOM_PER_POINT).exp());
    if factor != 1.0 {
        let at = pointer - rect.min;
        acts.push(Intent::Zoom {
            at: Vec2::new(at.x, at.y),
            factor,
        });
    }
}
