//! Film strip below the track of the timeline: thumbnails of the film, each at its t.

use bevy_egui::egui::{Color32, Id, LayerId, Order, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{RADIUS, ThemePalette};
use crate::app::ui::timeline::design_thumbnails::ThumbnailDrag;
use crate::app::ui::timeline::ruler::TimelineRuler;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::view::filmstrip;
use crate::app::view::filmstrip::THUMBNAIL_PX;

/// Height that the film strip adds to the timeline, in points.
pub const HEIGHT: f32 = 40.0;

/// Maximum width and height of a thumbnail, in points: half its size in pixels, so that it is sharp
/// on displays with two pixels per point.
const MAX_THUMBNAIL: (f32, f32) = (THUMBNAIL_PX.x as f32 / 2.0, THUMBNAIL_PX.y as f32 / 2.0);

/// Minimum width of a thumbnail, in points. If there is less room, some thumbnails are skipped.
const MIN_THUMBNAIL_WIDTH: f32 = 40.0;

/// Minimum gap between two thumbnails, in points.
const GAP: f32 = 6.0;

/// Draws the film strip below the y coordinate `top`, and handles the pointer on the thumbnails of
/// designs.
pub fn show(ui: &Ui, state: &UiState, ruler: TimelineRuler, top: f32, intents: &mut Intents) {
    let Some(pictures) = state.filmstrip.pictures() else {
        return;
    };
    let segments = state.session.segment_count();
    let count = filmstrip::thumbnail_count(segments);
    let longest = THUMBNAIL_PX.x * count as u32;
    let texture = texture(ui.ctx(), Id::new("filmstrip"), pictures, longest);
    let palette = ThemePalette::of(ui);
    let last = count - 1;
    let t = |index: usize| segments as f64 * index as f64 / last as f64;
    let spacing = ruler.x(t(1)) - ruler.x(t(0));
    // Every `step`-th thumbnail is shown. The step divides the index of the last thumbnail, so that
    // the first and the last one are shown.
    let Some(step) = (1..=last)
        .filter(|step| last.is_multiple_of(*step))
        .find(|step| spacing * *step as f32 >= MIN_THUMBNAIL_WIDTH + GAP)
    else {
        return;
    };
    let width = (spacing * step as f32 - GAP).min(MAX_THUMBNAIL.0);
    let size = vec2(width, width * MAX_THUMBNAIL.1 / MAX_THUMBNAIL.0);
    let [r, g, b] = state.session.style().ground.0;
    let current = state.playback.t() / segments as f64 * last as f64;
    let mut drag = ThumbnailDrag::new(state, ruler);
    for index in (0..count).step_by(step) {
        let middle = pos2(ruler.x(t(index)), top + MAX_THUMBNAIL.1 / 2.0);
        let slot = Rect::from_center_size(middle, size);
        let offset = drag
            .as_mut()
            .map_or(0.0, |drag| drag.interact(ui, t(index), slot, intents));
        let rect = slot.translate(vec2(offset, 0.0));
        // The dragged thumbnail is drawn above the others.
        let painter = match offset == 0.0 {
            true => ui.painter().clone(),
            false => ui.painter().clone().with_layer_id(drag_layer()),
        };
        painter.rect_filled(rect, RADIUS, Color32::from_rgb(r, g, b));
        let u = |k: usize| k as f32 / count as f32;
        let uv = Rect::from_min_max(pos2(u(index), 0.0), pos2(u(index + 1), 1.0));
        painter.image(texture.id(), rect.shrink(2.0), uv, Color32::WHITE);
        let is_current = (current - index as f64).abs() <= 0.5 * step as f64;
        let ink = if is_current || offset != 0.0 {
            palette.accent
        } else {
            palette.line
        };
        painter.rect_stroke(rect, RADIUS, Stroke::new(1.0, ink), StrokeKind::Inside);
    }
    if let Some(drag) = drag {
        drag.draw_drop_marker(ui, top, size.y);
    }
}

fn drag_layer() -> LayerId {
    LayerId::new(Order::Tooltip, Id::new("dragged design"))
}
