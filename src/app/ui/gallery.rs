//! Gallery panel on the left: a list of recent projects, and the bundled projects as cards with
//! film strips.

use std::collections::HashMap;

use bevy::prelude::Resource;
use bevy_egui::egui::{
    self, Align, Button, Color32, ColorImage, Layout, Panel, Rect, Response, RichText, ScrollArea,
    Sense, StrokeKind, TextureHandle, TextureOptions, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::app::files::gallery_thumbnails::STRIP_PX;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{CARD_RADIUS, GRID, RADIUS, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::project::gallery;

/// Width of the gallery panel, in points.
const WIDTH: f32 = 232.0;

/// Height of the film strip on the card of a project, in points.
const PICTURE_HEIGHT: f32 = 72.0;

/// Textures of the film strips that have been uploaded to the GPU, by project name.
#[derive(Resource, Default)]
pub struct GalleryTextures(HashMap<String, TextureHandle>);

/// Draws the gallery panel.
pub fn show(root: &mut Ui, state: &UiState, textures: &mut GalleryTextures, intents: &mut Intents) {
    let frame = panel_frame(root, [16, 8, 8, 0]);
    Panel::left("gallery")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            recent(ui, state, intents);
            ui.label(secondary_text(ui, "Gallery").strong());
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                // The cards are narrower than the panel, which leaves room for the scroll bar.
                ui.set_width(WIDTH - 32.0);
                for entry in &state.gallery.0 {
                    if card(ui, state, textures, entry).clicked() {
                        intents.push(Intent::PlayGallery(entry.name.clone()));
                    }
                }
                ui.add_space(GRID);
            });
        });
}

/// Lists the titles of recently opened projects; a click on a title opens the project.
fn recent(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let opened = state.recent.entries();
    if opened.is_empty() {
        return;
    }
    ui.label(secondary_text(ui, "Recent").strong());
    ui.set_max_width(WIDTH - 32.0);
    ui.with_layout(Layout::top_down_justified(Align::LEFT), |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for opened in opened {
            let title = RichText::new(opened.title()).font(SMALL);
            let line = Button::new(title).frame_when_inactive(false).truncate();
            let files = opened.files.iter().map(|file| file.display().to_string());
            let tip = files.collect::<Vec<_>>().join("\n");
            if ui.add(line).on_hover_text(tip).clicked() {
                intents.push(Intent::Open(opened.files.clone()));
            }
        }
    });
    ui.add_space(GRID);
}

fn card(
    ui: &mut Ui,
    state: &UiState,
    textures: &mut GalleryTextures,
    entry: &gallery::GalleryEntry,
) -> Response {
    let palette = ThemePalette::of(ui);
    let (width, ink) = (ui.available_width(), palette.text);
    // Titles are wrapped, not truncated, because similar titles often differ only at the end.
    let title = ui
        .painter()
        .layout(entry.title.clone(), SMALL, ink, width - 16.0);
    let size = vec2(width, PICTURE_HEIGHT + 12.0 + title.size().y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let is_open = state.session.gallery_name() == Some(entry.name.as_str());
    if is_open {
        show_when_new(ui, &entry.name, &response);
    }
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, true, is_open, &entry.title)
    });
    let (fill, line) = match (is_open, response.hovered()) {
        (true, _) => (palette.accent_fill, palette.accent),
        (false, true) => (palette.hover, palette.line),
        (false, false) => (palette.raised, Color32::TRANSPARENT),
    };
    ui.painter()
        .rect(rect, CARD_RADIUS, fill, (1.0, line), StrokeKind::Inside);
    let picture = Rect::from_min_size(rect.min, vec2(rect.width(), PICTURE_HEIGHT)).shrink(4.0);
    thumbnail(ui, state, textures, &entry.name, picture);
    let title_corner = rect.left_top() + vec2(8.0, PICTURE_HEIGHT + 4.0);
    ui.painter().galley(title_corner, title, ink);
    response.on_hover_text(&entry.description)
}

/// Scrolls once to the card of a project that has just been opened.
fn show_when_new(ui: &Ui, name: &str, card: &Response) {
    let id = egui::Id::new("the card that was scrolled to");
    let is_new = ui.data_mut(|data| {
        let last = data.get_temp_mut_or_default::<String>(id);
        // The list scrolls only once, so that the user can scroll away from the card afterwards.
        let is_new = last != name;
        name.clone_into(last);
        is_new
    });
    if is_new {
        card.scroll_to_me(None);
    }
}

/// Draws the film strip of the project `name`, as large as it fits into `rect`. Draws an empty box
/// while the strip is not ready.
pub fn thumbnail(ui: &Ui, state: &UiState, textures: &mut GalleryTextures, name: &str, rect: Rect) {
    ui.painter()
        .rect_filled(rect, RADIUS, ThemePalette::of(ui).panel);
    let Some(image) = state.thumbnails.get(name) else {
        return;
    };
    // A film strip never changes, so it is uploaded only once.
    let texture = textures.0.entry(name.to_owned()).or_insert_with(|| {
        let size = [image.width() as usize, image.height() as usize];
        let pixels = ColorImage::from_rgba_unmultiplied(size, image.as_raw());
        ui.ctx().load_texture(name, pixels, TextureOptions::LINEAR)
    });
    let full_uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let fitted = fit(rect, STRIP_PX.0 as f32 / STRIP_PX.1 as f32);
    ui.painter()
        .image(texture.id(), fitted, full_uv, Color32::WHITE);
}

fn fit(rect: Rect, aspect: f32) -> Rect {
    let height = rect.height().min(rect.width() / aspect);
    Rect::from_center_size(rect.center(), vec2(height * aspect, height))
}
