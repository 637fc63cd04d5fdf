//! Map sections of the inspector: the path over the map with its stops, and the saved blends with
//! name, rating and note.

use bevy_egui::egui::{Color32, Id, Label, Rect, RichText, Sense, TextEdit, Ui, pos2, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, hint, icon_button, section};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::project::{MapSettings, SavedBlend};
use crate::space::MapPath;

/// Width of the number in the row of a stop, in points.
const NUMBER_WIDTH: f32 = 16.0;

/// Width of a star of a rating, in points.
const STAR_WIDTH: f32 = 14.0;

/// Draws the sections of the path and of the saved blends.
pub fn show(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let Some(project) = state.session.whole_project() else {
        return;
    };
    let mut draft = project.map.clone();
    section(ui, "Path", |ui| path(ui, &mut draft));
    section(ui, "Saved blends", |ui| {
        saved_blends(ui, state, &mut draft, intents)
    });
    if draft != project.map {
        intents.push(Intent::EditMap(Box::new(draft)));
    }
}

fn path(ui: &mut Ui, draft: &mut MapSettings) {
    if draft.path.places.is_empty() {
        hint(
            ui,
            "Press E, then click or draw on the map: the film follows the path from stop to stop. \
             Or press W, move the marker, and press W again.",
        );
        return;
    }
    let mut is_removed = false;
    ui.horizontal(|ui| {
        from_right(ui, |ui| {
            let tip = "Remove path; the film goes from design to design again";
            is_removed = icon_button(ui, icons::CLOSE, tip, vec2(24.0, 24.0)).clicked();
            let name = TextEdit::singleline(&mut draft.path.name).hint_text("Path name");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    });
    let last = draft.path.places.len() - 1;
    let stops = draft.path.places.iter_mut().enumerate();
    let stops = stops.filter(|(k, place)| *k == 0 || *k == last || !place.passed);
    for (number, (_, stop)) in stops.enumerate() {
        ui.horizontal(|ui| {
            let words = RichText::new(format!("{}", number + 1)).color(ThemePalette::of(ui).weak);
            ui.add_sized([NUMBER_WIDTH, CONTROL_HEIGHT], Label::new(words));
            let name = TextEdit::singleline(&mut stop.name).hint_text("Stop");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    }
    if is_removed {
        draft.path = MapPath::default();
    }
}

fn saved_blends(ui: &mut Ui, state: &UiState, draft: &mut MapSettings, intents: &mut Intents) {
    if draft.kept.is_empty() {
        hint(ui, "Press K to save the blend under the marker.");
        return;
    }
    let mut removed = None;
    for (k, place) in draft.kept.iter_mut().enumerate() {
        ui.push_id(("kept", k), |ui| {
            ui.horizontal(|ui| {
                picture(ui, state, k, place, intents);
                ui.vertical(|ui| {
                    if entry(ui, place) {
                        removed = Some(k);
                    }
                });
            });
            ui.add_space(0.5 * GRID);
        });
    }
    if let Some(k) = removed {
        draft.kept.remove(k);
    }
    ui.horizontal(|ui| {
        let tip = "Best first; equal ratings stay in the order in which they were saved";
        if ui.button("Sort by rating").on_hover_text(tip).clicked() {
            draft
                .kept
                .sort_by_key(|place| std::cmp::Reverse(place.stars));
        }
        let tip = "Exports each blend as SVG and DXF, an overview sheet and a table of measures";
        if ui.button("Export").on_hover_text(tip).clicked() {
            intents.push(Intent::ExportSavedBlends);
        }
    });
}

/// Draws the thumbnail of the saved blend with the index `k`. A click moves the marker to the place
/// of the blend.
fn picture(ui: &mut Ui, state: &UiState, k: usize, place: &SavedBlend, intents: &mut Intents) {
    let side = 2.0 * CONTROL_HEIGHT + ui.spacing().item_spacing.y;
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
    let Rgb([r, g, b]) = state.session.style().ground;
    let background = Color32::from_rgb(r, g, b);
    ui.painter().rect_filled(rect, RADIUS, background);
    let thumbnail = state
        .map
        .pictures()
        .and_then(|pictures| pictures.saved_blend(place.at));
    if let Some(thumbnail) = thumbnail {
        let texture = texture(ui.ctx(), Id::new(("kept", k)), thumbnail, u32::MAX);
        let full_uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let painter = ui.painter();
        painter.image(texture.id(), rect.shrink(2.0), full_uv, Color32::WHITE);
    }
    if response.on_hover_text("Go there").clicked() {
        intents.push(Intent::MoveMarker(place.at));
    }
}

/// Draws name, rating and note of a saved blend; returns whether the user removes the blend.
fn entry(ui: &mut Ui, place: &mut SavedBlend) -> bool {
    let mut is_removed = false;
    ui.horizontal(|ui| {
        from_right(ui, |ui| {
            is_removed = icon_button(ui, icons::CLOSE, "Remove", vec2(24.0, 24.0)).clicked();
            let name = TextEdit::singleline(&mut place.name).hint_text("Name");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    });
    ui.horizontal(|ui| {
        stars(ui, place);
        let note = TextEdit::singleline(&mut place.note).hint_text("Note");
        ui.add_sized([ui.available_width(), CONTROL_HEIGHT], note);
    });
    is_removed
}

/// Draws the rating of a saved blend. A click on a star sets the rating, a click on the last filled
/// star clears it.
fn stars(ui: &mut Ui, place: &mut SavedBlend) {
    ui.spacing_mut().item_spacing.x = 0.0;
    let rating = place.stars;
    for star in 1..=SavedBlend::MOST_STARS {
        let palette = ThemePalette::of(ui);
        let (icon, ink) = match star <= rating {
            true => (icons::STAR, palette.amber),
            false => (icons::STAR_OUTLINE, palette.weak),
        };
        let (rect, response) =
            ui.allocate_exact_size(vec2(STAR_WIDTH, CONTROL_HEIGHT), Sense::click());
        icons::paint_icon(ui.painter(), icon, rect, ink);
        if response
            .on_hover_text(format!("{star} of 5 stars"))
            .clicked()
        {
            place.stars = if star == rating { 0 } else { star };
        }
    }
    ui.add_space(GRID);
}
