//! What can be set about the map while it is shown: the path over it, and the places that are kept.

use bevy_egui::egui::{Align, Label, Layout, RichText, Sense, TextEdit, Ui, vec2};

use crate::app::asking::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, Palette};
use crate::app::ui::kit::widgets::{from_right, hint, icon_button, section};
use crate::app::ui::scene::{Intents, Scene};
use crate::project::{KeptPlace, MapSettings};
use crate::space::MapPath;

/// Width of a number before a row.
const NUMBER: f32 = 16.0;

/// Width of a star.
const STAR: f32 = 14.0;

/// Draws both.
pub fn show(ui: &mut Ui, scene: &Scene, acts: &mut Intents) {
    let Some(whole) = scene.session.whole() else {
        return;
    };
    let mut draft = whole.map.clone();
    section(ui, "Path", |ui| path(ui, &mut draft));
    section(ui, "Kept", |ui| kept(ui, &mut draft, acts));
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
            let words = RichText::new(format!("{}", number + 1)).color(Palette::of(ui).weak);
            ui.add_sized([NUMBER, CONTROL_HEIGHT], Label::new(words));
            let name = TextEdit::singleline(&mut stop.name).hint_text("Stop");
            ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
        });
    }
    if is_gone {
        draft.path = MapPath::default();
    }
}

fn kept(ui: &mut Ui, draft: &mut MapSettings, acts: &mut Intents) {
    if draft.kept.is_empty() {
        hint(ui, "Press K to keep the blend under the puck.");
        return;
    }
    let mut gone = None;
    for (k, place) in draft.kept.iter_mut().enumerate() {
        ui.push_id(("kept", k), |ui| {
            ui.horizontal(|ui| {
                from_right(ui, |ui| {
                    if icon_button(ui, icons::CLOSE, "Keep it no more", vec2(24.0, 24.0)).clicked()
                    {
                        gone = Some(k);
                    }
                    if icon_button(ui, icons::PLACE, "Go there", vec2(24.0, 24.0)).clicked() {
                        acts.push(Intent::Puck(place.at));
                    }
                    let name = TextEdit::singleline(&mut place.name).hint_text("Name");
                    ui.add_sized([ui.available_width(), CONTROL_HEIGHT], name);
                });
            });
            ui.horizontal(|ui| {
                stars(ui, place);
                let left = Layout::left_to_right(Align::Center);
                let room = vec2(ui.available_width(), CONTROL_HEIGHT);
                ui.allocate_ui_with_layout(room, left, |ui| {
                    let note = TextEdit::singleline(&mut place.note).hint_text("Note");
                    ui.add_sized([ui.available_width(), CONTROL_HEIGHT], note);
                });
            });
            ui.add_space(0.5 * GRID);
        });
    }
    if let Some(k) = gone {
        draft.kept.remove(k);
    }
}

/// A click on a star gives as many; on the last one that is given none.
fn stars(ui: &mut Ui, place: &mut KeptPlace) {
    ui.spacing_mut().item_spacing.x = 0.0;
    let given = place.stars;
    for star in 1..=KeptPlace::MOST_STARS {
        let palette = Palette::of(ui);
        let (icon, ink) = match star <= given {
            true => (icons::STAR, palette.amber),
            false => (icons::NO_STAR, palette.weak),
        };
        let (rect, response) = ui.allocate_exact_size(vec2(STAR, CONTROL_HEIGHT), Sense::click());
        icons::paint(ui.painter(), icon, rect, ink);
        if response.on_hover_text(format!("{star} of 5")).clicked() {
            place.stars = if star == given { 0 } else { star };
        }
    }
    ui.add_space(GRID);
}
