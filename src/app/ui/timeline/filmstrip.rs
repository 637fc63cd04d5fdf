//! Small pictures of the film below the track, each where its t is.

use bevy_egui::egui::{Color32, Id, LayerId, Order, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{RADIUS, ThemePalette};
use crate::app::ui::timeline::design_thumbnails::ThumbnailDrag;
use crate::app::ui::timeline::ruler::TimelineRuler;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::view::filmstrip;
use crate::app::view::filmstrip::PICTURE_PX;

/// What the pictures add to the height of the timeline.
pub const HEIGHT: f32 = 40.0;

/// The largest picture, half as many points as it has pixels.
const LARGEST: (f32, f32) = (PICTURE_PX.0 as f32 / 2.0, PICTURE_PX.1 as f32 / 2.0);

/// The smallest width in which something can be told: with less, some are left out.
const LEAST: f32 = 40.0;

/// Between two pictures.
const GAP: f32 = 6.0;

/// Draws them below `top`, and takes the user's hand on those of designs.
pub fn show(ui: &Ui, scene: &UiState, ruler: TimelineRuler, top: f32, acts: &mut Intents) {
    let Some(pictures) = scene.filmstrip.pictures() else {
        return;
    };
    let legs = scene.session.leg_count();
    let count = filmstrip::pictures(legs);
    let longest = PICTURE_PX.0 * count as u32;
    let texture = texture(ui.ctx(), Id::new("filmstrip"), pictures, longest);
    let palette = ThemePalette::of(ui);
    let last = count - 1;
    let t = |index: usize| legs as f64 * index as f64 / last as f64;
    let apart = ruler.x(t(1)) - ruler.x(t(0));
    // Of a pair 1, 2, 5 or 10: both ends are always there.
    let Some(step) = (1..=last)
        .filter(|step| last.is_multiple_of(*step))
        .find(|step| apart * *step as f32 >= LEAST + GAP)
    else {
        return;
    };
    let width = (apart * step as f32 - GAP).min(LARGEST.0);
    let size = vec2(width, width * LARGEST.1 / LARGEST.0);
    let [r, g, b] = scene.session.style().ground.0;
    let now = scene.playback.t() / legs as f64 * last as f64;
    let mut hand = ThumbnailDrag::of(scene, ruler);
    for index in (0..count).step_by(step) {
        let middle = pos2(ruler.x(t(index)), top + LARGEST.1 / 2.0);
        let place = Rect::from_center_size(middle, size);
        let beside = hand
            .as_mut()
            .map_or(0.0, |hand| hand.hold(ui, t(index), place, acts));
        let rect = place.translate(vec2(beside, 0.0));
        // What is dragged lies over the others.
        let painter = match beside == 0.0 {
            true => ui.painter().clone(),
            false => ui.painter().clone().with_layer_id(dragged()),
        };
        painter.rect_filled(rect, RADIUS, Color32::from_rgb(r, g, b));
        let share = |k: usize| k as f32 / count as f32;
        let part = Rect::from_min_max(pos2(share(index), 0.0), pos2(share(index + 1), 1.0));
        painter.image(texture.id(), rect.shrink(2.0), part, Color32::WHITE);
        let is_here = (now - index as f64).abs() <= 0.5 * step as f64;
        let ink = if is_here || beside != 0.0 {
            palette.accent
        } else {
            palette.line
        };
        painter.rect_stroke(rect, RADIUS, Stroke::new(1.0, ink), StrokeKind::Inside);
    }
    if let Some(hand) = hand {
        hand.mark(ui, top, size.y);
    }
}

fn dragged() -> LayerId {
    LayerId::new(Order::Tooltip, Id::new("dragged design"))
}
