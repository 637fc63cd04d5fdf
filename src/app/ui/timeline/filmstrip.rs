//! Small pictures of the film below the track, each where its t is.

use bevy_egui::egui::{Color32, Id, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::app::looking::filmstrip::{self, PICTURE_PX};
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{Palette, RADIUS};
use crate::app::ui::scene::Scene;

/// What the pictures add to the height of the timeline.
pub const HEIGHT: f32 = 40.0;

/// The largest picture, half as many points as it has pixels.
const LARGEST: (f32, f32) = (PICTURE_PX.0 as f32 / 2.0, PICTURE_PX.1 as f32 / 2.0);

/// The smallest width in which something can be told: with less, some are left out.
const LEAST: f32 = 40.0;

/// Between two pictures.
const GAP: f32 = 6.0;

/// Draws them below `top`; `x` says where a t is.
pub fn show(ui: &Ui, scene: &Scene, x: impl Fn(f64) -> f32, top: f32) {
    let Some(pictures) = scene.filmstrip.pictures() else {
        return;
    };
    let legs = scene.session.leg_count();
    let count = filmstrip::pictures(legs);
    let longest = PICTURE_PX.0 * count as u32;
    let texture = texture(ui.ctx(), Id::new("filmstrip"), pictures, longest);
    let palette = Palette::of(ui);
    let last = count - 1;
    let t = |index: usize| legs as f64 * index as f64 / last as f64;
    let apart = x(t(1)) - x(t(0));
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
    for index in (0..count).step_by(step) {
        let middle = pos2(x(t(index)), top + LARGEST.1 / 2.0);
        let rect = Rect::from_center_size(middle, size);
        let painter = ui.painter();
        painter.rect_filled(rect, RADIUS, Color32::from_rgb(r, g, b));
        let share = |k: usize| k as f32 / count as f32;
        let part = Rect::from_min_max(pos2(share(index), 0.0), pos2(share(index + 1), 1.0));
        let inner = rect.shrink(2.0);
        painter.image(texture.id(), inner, part, Color32::WHITE);
        let is_here = (now - index as f64).abs() <= 0.5 * step as f64;
        let ink = if is_here {
            palette.accent
        } else {
            palette.line
        };
        painter.rect_stroke(rect, RADIUS, Stroke::new(1.0, ink), StrokeKind::Inside);
    }
}
