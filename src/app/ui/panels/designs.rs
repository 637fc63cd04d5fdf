//! The designs: their order, how they are read, and how they lie in one frame.

use std::ops::RangeInclusive;

use bevy_egui::egui::{
    Align, CollapsingHeader, Color32, DragValue, Label, Layout, RichText, Sense, Ui, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{
    automatic_toggle, choice_row, drag, from_right, icon_button, number, row, secondary_text,
    section, slider, toggle,
};
use crate::app::ui::stage::checks::capitalised;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::design::{Format, ImportNote};
use crate::project::{DesignEntry, MovedDesigns, Project};

/// The grey level that is started from when it is set by hand.
const MIDDLE_GREY: u8 = 128;

/// The scales that the slider runs over, which is some hundred points long: over more, and a hand
/// cannot set one.
const SCALES: RangeInclusive<f64> = 0.25..=4.0;

/// Draws all designs, and of the two that are looked at everything.
pub fn show(ui: &mut Ui, scene: &UiState, draft: &mut Project, acts: &mut Intents) {
    let Some(whole) = scene.session.whole() else {
        return;
    };
    // A path goes between all.
    let numbers = match whole.follows_path() {
        true => (0..whole.designs.len()).collect(),
        false => whole.leg_designs(scene.session.leg()).to_vec(),
    };
    let last = numbers.len().saturating_sub(1).max(1) as f64;
    section(ui, "Designs", |ui| {
        if whole.is_sequence() {
            order(ui, scene, whole, acts);
        }
        add(ui, whole, acts);
        let tip = "How unlike designs are laid over each other before anything else.";
        choice_row(ui, "Frame", tip, &mut draft.fit);
        let style = scene.session.style_here();
        let seen = draft.designs.iter_mut().zip(&numbers).enumerate();
        for (index, (entry, &number)) in seen {
            let colour = style.fill_at(index as f64 / last);
            let role = match (whole.follows_path(), index) {
                (true, _) => format!("{}", number + 1),
                (false, 0) => "Source".to_owned(),
                (false, _) => "Target".to_owned(),
            };
            design(ui, (index, number), (&role, colour), entry, acts);
            if let Some(design) = scene.session.all_designs().get(number) {
                notes(ui, index, &design.notes);
            }
        }
        if !whole.is_sequence() && swap(ui) {
            draft.designs.swap(0, 1);
            // What was said by hand is of points of the designs, and changes sides with them.
            draft.options.matching = draft.options.matching.swapped();
            let parts = draft.options.parts.iter_mut();
            parts.for_each(|part| *part = part.swapped());
            let coats = &mut draft.options.coats;
            coats.reorder_at = 1.0 - coats.reorder_at;
        }
    });
}

/// The list of all designs, in which they change places.
fn order(ui: &mut Ui, scene: &UiState, whole: &Project, acts: &mut Intents) {
    let here = whole.leg_designs(scene.session.leg());
    for (k, entry) in whole.designs.iter().enumerate() {
        ui.horizontal(|ui| {
            let words = RichText::new(format!("{}", k + 1)).color(ThemePalette::of(ui).weak);
            ui.add_sized([16.0, CONTROL_HEIGHT], Label::new(words));
            from_right(ui, |ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                moves(ui, whole, k, acts);
                let name = RichText::new(entry.shown_name());
                let name = match here.contains(&k) {
                    true => name.strong(),
                    false => name,
                };
                let label = Label::new(name).truncate().sense(Sense::click());
                let tip = format!("{}\nClick to go there.", entry.path.display());
                let left = Layout::left_to_right(Align::Center);
                let room = vec2(ui.available_width(), CONTROL_HEIGHT);
                let label = ui.allocate_ui_with_layout(room, left, |ui| ui.add(label));
                if label.inner.on_hover_text(tip).clicked() {
                    acts.push(Intent::Seek(k as f64));
                }
            });
        });
    }
    let mut closed = whole.closed;
    let tip = "The last design leads back to the first: a film that can run for ever.";
    toggle(ui, "Lead back", tip, &mut closed);
    if closed != whole.closed {
        acts.push(Intent::LeadBack(closed));
    }
}

/// The buttons that move a design among the others, from right to left.
fn moves(ui: &mut Ui, whole: &Project, k: usize, acts: &mut Intents) {
    let last = whole.designs.len() - 1;
    let mut button = |icon, tip: &str, order: Option<Vec<MovedDesigns>>| {
        ui.add_enabled_ui(order.is_some(), |ui| {
            if icon_button(ui, icon, tip, vec2(24.0, 24.0)).clicked() {
                acts.extend(order.map(Intent::Arrange));
            }
        });
    };
    let out = (last > 1).then(|| whole.without(k));
    button(icons::CLOSE, "Take it out", out);
    let twice = whole.with_repeated(k);
    button(icons::COPY, "Once more behind it", Some(twice));
    let later = (k < last).then(|| whole.with_moved(k, k + 2)).flatten();
    button(icons::DOWN, "Later", later);
    let earlier = k.checked_sub(1).and_then(|to| whole.with_moved(k, to));
    button(icons::UP, "Earlier", earlier);
}

fn add(ui: &mut Ui, whole: &Project, acts: &mut Intents) {
    let button = ui.button("Add designs …");
    let tip = "Further designs behind the last one: the film goes through all of them.";
    if button.on_hover_text(tip).clicked() {
        acts.push(Intent::AskInsert(whole.designs.len()));
    }
    ui.add_space(4.0);
}

fn swap(ui: &mut Ui) -> bool {
    let tip = "Exchanges source and target: the film runs the other way.";
    icon_button(ui, icons::SWAP, tip, vec2(32.0, CONTROL_HEIGHT)).clicked()
}

/// One of those that are looked at, and its number among all.
fn design(
    ui: &mut Ui,
    (index, number): (usize, usize),
    (role, colour): (&str, Rgb),
    entry: &mut DesignEntry,
    acts: &mut Intents,
) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let (dot, _) = ui.allocate_exact_size(vec2(12.0, CONTROL_HEIGHT), Sense::hover());
        let fill = Color32::from_rgb(colour.0[0], colour.0[1], colour.0[2]);
        ui.painter().circle_filled(dot.center(), 5.0, fill);
        ui.label(secondary_text(ui, role));
        from_right(ui, |ui| {
            let tip = "Another file in its place";
            if icon_button(ui, icons::OPEN, tip, vec2(24.0, 24.0)).clicked() {
                acts.push(Intent::AskReplace(number));
            }
            let path = entry.path.display().to_string();
            ui.add(Label::new(entry.shown_name()).truncate())
                .on_hover_text(path);
        });
    });
    let id = ui.id().with(("placement", index));
    ui.push_id(id, |ui| {
        CollapsingHeader::new("Placement").show_unindented(ui, |ui| placement(ui, entry));
        if is_picture(entry) {
            CollapsingHeader::new("Reading the picture")
                .show_unindented(ui, |ui| reading(ui, entry));
        }
    });
}

/// What was repaired or left out when the design was read.
fn notes(ui: &mut Ui, index: usize, notes: &[ImportNote]) {
    let title = match notes {
        [] => return,
        [_] => "1 note on how it was read".to_owned(),
        notes => format!("{} notes on how it was read", notes.len()),
    };
    let title = RichText::new(title).color(ThemePalette::of(ui).amber);
    let id = ui.id().with(("notes", index));
    let header = CollapsingHeader::new(title).id_salt(id);
    header.show_unindented(ui, |ui| {
        for note in notes {
            ui.label(RichText::new(capitalised(&note.to_string())).small());
        }
        ui.add_space(GRID);
    });
}

fn placement(ui: &mut Ui, entry: &mut DesignEntry) {
    let place = &mut entry.placement;
    row(
        ui,
        "Offset",
        "Moves this design right and up, in its own units.",
        |ui| {
            let field = |ui: &mut Ui, value: &mut f64, prefix: &str| {
                let drag = DragValue::new(value)
                    .speed(0.01)
                    .prefix(prefix.to_owned())
                    .max_decimals(3);
                ui.add_sized([76.0, CONTROL_HEIGHT], drag)
            };
            field(ui, &mut place.offset.x, "x ") | field(ui, &mut place.offset.y, "y ")
        },
    );
    let tip = "Enlarges this design about its own middle.";
    slider(ui, "Scale", tip, &mut place.scale, SCALES, true);
    let mut degrees = place.rotation.to_degrees();
    let tip = "Turns this design counter-clockwise, in degrees.";
    slider(ui, "Rotation", tip, &mut degrees, -180.0..=180.0, false);
    // To degrees and back is not the same number: being drawn would change the project.
    if (degrees - place.rotation.to_degrees()).abs() > 1e-9 {
        place.rotation = degrees.to_radians();
    }
    let tip = "Exchanges left and right of this design.";
    toggle(ui, "Mirror", tip, &mut place.mirror);
}

fn is_picture(entry: &DesignEntry) -> bool {
    Format::PICTURES
        .iter()
        .any(|format| format.ends(&entry.path))
}

fn reading(ui: &mut Ui, entry: &mut DesignEntry) {
    let import = &mut entry.import;
    let tip = "Each flat colour of the picture is a part of its own, and keeps its colour.";
    toggle(ui, "By colour", tip, &mut import.colours);
    let tip = "Finds the grey level that parts shape from ground by itself.";
    automatic_toggle(ui, "Automatic", tip, &mut import.threshold, MIDDLE_GREY);
    if let Some(threshold) = &mut import.threshold {
        let level = drag(threshold, 1..=255, 0.5, 0);
        let tip = "Where shape ends and ground begins, 1 to 255: higher lets more in.";
        number(ui, "Grey level", tip, level);
    }
    let tip = "Takes the ground for the shape.";
    toggle(ui, "Invert", tip, &mut import.invert);
    let specks = DragValue::new(&mut import.specks_px).speed(0.2);
    let tip = "Spots and holes of fewer pixels than this are left out.";
    number(ui, "Specks", tip, specks);
    let tolerance = drag(&mut import.tolerance, 0.0..=0.1, 0.0001, 4);
    let tip = "How far the outline may run from the exact edge, as a part of the longer side: larger has fewer corners.";
    number(ui, "Tolerance", tip, tolerance);
    ui.add_space(GRID);
}
