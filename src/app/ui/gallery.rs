//! The bundled projects, each as a film strip.

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

const WIDTH: f32 = 232.0;
const PICTURE_HEIGHT: f32 = 72.0;

/// The thumbnails that egui already has.
#[derive(Resource, Default)]
pub struct GalleryTextures(HashMap<String, TextureHandle>);

/// Draws the gallery on the left.
pub fn show(root: &mut Ui, scene: &UiState, textures: &mut GalleryTextures, acts: &mut Intents) {
    let frame = panel_frame(root, [16, 8, 8, 0]);
    Panel::left("gallery")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            recent(ui, scene, acts);
            ui.label(secondary_text(ui, "Gallery").strong());
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                // Less than there is: the scroll bar stands in the rest.
                ui.set_width(WIDTH - 32.0);
                for entry in &scene.gallery.0 {
                    if card(ui, scene, textures, entry).clicked() {
                        acts.push(Intent::OpenGallery(entry.name.clone()));
                    }
                }
                ui.add_space(GRID);
            });
        });
}

/// What was opened last, a line each.
fn recent(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let opened = scene.recent.opened();
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
                acts.push(Intent::Open(opened.files.clone()));
            }
        }
    });
    ui.add_space(GRID);
}

fn card(
    ui: &mut Ui,
    scene: &UiState,
    textures: &mut GalleryTextures,
    entry: &gallery::GalleryEntry,
) -> Response {
    let palette = ThemePalette::of(ui);
    let (width, ink) = (ui.available_width(), palette.text);
    // Wrapped: what tells two of them apart may stand at the end.
    let title = ui
        .painter()
        .layout(entry.title.clone(), SMALL, ink, width - 16.0);
    let size = vec2(width, PICTURE_HEIGHT + 12.0 + title.size().y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let is_open = scene.session.gallery_name() == Some(entry.name.as_str());
    if is_open {
        show_when_new(ui, &entry.name, &response);
    }
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, true, is_open, &entry.title)
    });
    let (fill, line) = match (is_open, response.hovered()) {
        (true, _) => (palette.accent_ground, palette.accent),
        (false, true) => (palette.hover, palette.line),
        (false, false) => (palette.raised, Color32::TRANSPARENT),
    };
    ui.painter()
        .rect(rect, CARD_RADIUS, fill, (1.0, line), StrokeKind::Inside);
    let picture = Rect::from_min_size(rect.min, vec2(rect.width(), PICTURE_HEIGHT)).shrink(4.0);
    thumbnail(ui, scene, textures, &entry.name, picture);
    let text_at = rect.left_top() + vec2(8.0, PICTURE_HEIGHT + 4.0);
    ui.painter().galley(text_at, title, ink);
    response.on_hover_text(&entry.description)
}

/// Scrolls to the card of a project that has just been opened, and then leaves the list alone.
fn show_when_new(ui: &Ui, name: &str, card: &Response) {
    let shown = egui::Id::new("the card that was scrolled to");
    let is_new = ui.data_mut(|data| {
        let last = data.get_temp_mut_or_default::<String>(shown);
        // Only when it is another: else the list could not be scrolled away from it.
        let is_new = last != name;
        name.clone_into(last);
        is_new
    });
    if is_new {
        card.scroll_to_me(None);
    }
}

fn thumbnail(ui: &Ui, scene: &UiState, textures: &mut GalleryTextures, name: &str, rect: Rect) {
    ui.painter()
        .rect_filled(rect, RADIUS, ThemePalette::of(ui).panel);
    let Some(image) = scene.thumbnails.get(name) else {
        return;
    };
    // Strips never change, so each goes to the graphics card once.
    let texture = textures.0.entry(name.to_owned()).or_insert_with(|| {
        let size = [image.width() as usize, image.height() as usize];
        let pixels = ColorImage::from_rgba_unmultiplied(size, image.as_raw());
        ui.ctx().load_texture(name, pixels, TextureOptions::LINEAR)
    });
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let fitted = fit(rect, STRIP_PX.0 as f32 / STRIP_PX.1 as f32);
    ui.painter()
        .image(texture.id(), fitted, whole, Color32::WHITE);
}

fn fit(rect: Rect, aspect: f32) -> Rect {
    let height = rect.height().min(rect.width() / aspect);
    Rect::from_center_size(rect.center(), vec2(height * aspect, height))
}
