//! What can be set about the map while it is shown: the path over it, and the places that are kept.

use bevy_egui::egui::{Color32, Id, Label, Rect, RichText, Sense, TextEdit, Ui, pos2, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, hint, icon_button, section};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::project::{MapSettings, SavedPlace};
use crate::space::MapPath;

/// Width of a number before a row.
const NUMBER: f32 = 16.0;

/// Width of a star.
const STAR: f32 = 14.0;

/// Draws both.
pub fn show(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let Some(whole) = scene.session.whole() else {
        return;
    };
    let mut draft = whole.map.clone();
    section(ui, "Path", |ui| path(ui, &mut draft));
    section(ui, "Kept", |ui| kept(ui, scene, &mut draft, acts));
    if draft != whole.map {
        acts.push(Intent::EditMap(Box::new(draft)));
    }
}

fn path(ui: &mut Ui, draft: &mut MapSettings) {
    if draft.path.places.is_empty() {
        hint(
            ui,
            "Press E and click on the map, or draw there: the film goes along the path, from stop \
             to stop. Or press W, move the puck, and W again.",
        );
        return;
    }
    let mut is_gone = false;
    ui.horizontal(|ui| {
        from_right(ui, |ui| {
            let tip = "Take the path away: the film goes from design to design again";
            is_gone = icon_button(ui, icons::CLOSE, tip, vec2(24.0, 24.0)).clicked();
            let name = TextEdit::singleline(&mut draft.path.name).hint_text("Name of the path");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    });
    let last = draft.path.places.len() - 1;
    let stops = draft.path.places.iter_mut().enumerate();
    let stops = stops.filter(|(k, place)| *k == 0 || *k == last || !place.passed);
    for (number, (_, stop)) in stops.enumerate() {
        ui.horizontal(|ui| {
            let words = RichText::new(format!("{}", number + 1)).color(ThemePalette::of(ui).weak);
            ui.add_sized([NUMBER, CONTROL_HEIGHT], Label::new(words));
            let name = TextEdit::singleline(&mut stop.name).hint_text("Stop");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    }
    if is_gone {
        draft.path = MapPath::default();
    }
}

fn kept(ui: &mut Ui, scene: &UiState, draft: &mut MapSettings, acts: &mut Intents) {
    if draft.kept.is_empty() {
        hint(ui, "Press K to keep the blend under the puck.");
        return;
    }
    let mut gone = None;
    for (k, place) in draft.kept.iter_mut().enumerate() {
        ui.push_id(("kept", k), |ui| {
            ui.horizontal(|ui| {
                picture(ui, scene, k, place, acts);
                ui.vertical(|ui| {
                    if entry(ui, place) {
                        gone = Some(k);
                    }
                });
            });
            ui.add_space(0.5 * GRID);
        });
    }
    if let Some(k) = gone {
        draft.kept.remove(k);
    }
    ui.horizontal(|ui| {
        let tip = "The best first, and of equal ones the first that was kept";
        if ui.button("Sort by stars").on_hover_text(tip).clicked() {
            draft
                .kept
                .sort_by_key(|place| std::cmp::Reverse(place.stars));
        }
        let tip = "Each as SVG and DXF, all as a sheet, their measures as a table";
        if ui.button("Export").on_hover_text(tip).clicked() {
            acts.push(Intent::ExportKept);
        }
    });
}

/// How it looks; a click goes there.
fn picture(ui: &mut Ui, scene: &UiState, k: usize, place: &SavedPlace, acts: &mut Intents) {
    let side = 2.0 * CONTROL_HEIGHT + ui.spacing().item_spacing.y;
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
    let Rgb([r, g, b]) = scene.session.style().ground;
    let ground = Color32::from_rgb(r, g, b);
    ui.painter().rect_filled(rect, RADIUS, ground);
    let small = scene.map.made().and_then(|made| made.kept(place.at));
    if let Some(small) = small {
        let texture = texture(ui.ctx(), Id::new(("kept", k)), small, u32::MAX);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let painter = ui.painter();
        painter.image(texture.id(), rect.shrink(2.0), whole, Color32::WHITE);
    }
    if response.on_hover_text("Go there").clicked() {
        acts.push(Intent::Puck(place.at));
    }
}

/// Its name, its stars and its note; whether it is kept no more.
fn entry(ui: &mut Ui, place: &mut SavedPlace) -> bool {
    let mut is_gone = false;
    ui.horizontal(|ui| {
        from_right(ui, |ui| {
            is_gone = icon_button(ui, icons::CLOSE, "Keep it no more", vec2(24.0, 24.0)).clicked();
            let name = TextEdit::singleline(&mut place.name).hint_text("Name");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    });
    ui.horizontal(|ui| {
        stars(ui, place);
        let note = TextEdit::singleline(&mut place.note).hint_text("Note");
        ui.add_sized([ui.available_width(), CONTROL_HEIGHT], note);
    });
    is_gone
}

/// A click on a star gives as many; on the last one that is given none.
fn stars(ui: &mut Ui, place: &mut SavedPlace) {
    ui.spacing_mut().item_spacing.x = 0.0;
    let given = place.stars;
    for star in 1..=SavedPlace::MOST_STARS {
        let palette = ThemePalette::of(ui);
        let (icon, ink) = match star <= given {
            true => (icons::STAR, palette.amber),
            false => (icons::STAR_OUTLINE, palette.weak),
        };
        let (rect, response) = ui.allocate_exact_size(vec2(STAR, CONTROL_HEIGHT), Sense::click());
        icons::paint_icon(ui.painter(), icon, rect, ink);
        if response.on_hover_text(format!("{star} of 5")).clicked() {
            place.stars = if star == given { 0 } else { star };
        }
    }
    ui.add_space(GRID);
}
