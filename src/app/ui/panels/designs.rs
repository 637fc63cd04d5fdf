//! Designs section of the inspector: the list of all designs, and for each design of the current
//! segment its file, its placement in the common frame, its import options and import notes.

use std::ops::RangeInclusive;

use bevy_egui::egui::{
    Align, Align2, CollapsingHeader, Color32, DragValue, Label, Layout, Rect, RichText, Sense,
    StrokeKind, TextStyle, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::app::files::picture_readings::ReadingChoice;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, RADIUS, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{
    automatic_toggle, drag_value, from_right, hint, icon_button, number, row, secondary_text,
    section, setting_row, slider, toggle,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::design::{Format, ImportNote, PictureReading};
use crate::project::{DesignEntry, MovedDesigns, Project};
use crate::settings::Choice;

/// Initial grey threshold of an image when the user turns off the automatic one: the middle of the
/// 256 grey levels.
const MIDDLE_GREY: u8 = 128;

/// Range of the slider for a design's scale. On a slider about 100 points long, a wider range could
/// not be set precisely.
const SCALE_RANGE: RangeInclusive<f64> = 0.25..=4.0;

/// Draws the designs section: the list of all designs, and the settings of the designs in the
/// current segment.
pub fn show(ui: &mut Ui, state: &UiState, draft: &mut Project, intents: &mut Intents) {
    let Some(project) = state.session.whole_project() else {
        return;
    };
    // A film along a path over the map blends all designs, so the settings of all are shown.
    let numbers = match project.follows_path() {
        true => (0..project.designs.len()).collect(),
        false => project.segment_designs(state.session.segment()).to_vec(),
    };
    let last = numbers.len().saturating_sub(1).max(1) as f64;
    section(ui, "Designs", |ui| {
        if project.is_sequence() {
            order(ui, state, project, intents);
        }
        add(ui, project, intents);
        let tip = "How the designs are aligned before they are matched.";
        setting_row(ui, "Align", tip, &mut draft.fit);
        let style = state.session.segment_style();
        let entries = draft.designs.iter_mut().zip(&numbers).enumerate();
        for (index, (entry, &number)) in entries {
            let colour = style.fill_at(index as f64 / last);
            let role = match (project.follows_path(), index) {
                (true, _) => format!("{}", number + 1),
                (false, 0) => "Source".to_owned(),
                (false, _) => "Target".to_owned(),
            };
            let heading = DesignHeading {
                index,
                number,
                role,
                colour,
            };
            design(ui, &heading, entry, intents);
            if let Some(design) = state.session.all_designs().get(number) {
                let choices = state.readings.choices(design);
                readings(ui, index, choices, &mut entry.import.reading);
                notes(ui, index, &design.notes);
            }
        }
        if !project.is_sequence() && swap(ui) {
            draft.designs.swap(0, 1);
            // Settings that refer to source and target must be swapped together with the designs.
            draft.options.matching = draft.options.matching.swapped();
            let parts = draft.options.parts.iter_mut();
            parts.for_each(|part| *part = part.swapped());
            let layers = &mut draft.options.coats;
            layers.reorder_at = 1.0 - layers.reorder_at;
        }
    });
}

/// Draws the list of all designs with buttons to reorder them, and the option that continues the
/// film from the last design to the first.
fn order(ui: &mut Ui, state: &UiState, project: &Project, intents: &mut Intents) {
    let current = project.segment_designs(state.session.segment());
    for (k, entry) in project.designs.iter().enumerate() {
        ui.horizontal(|ui| {
            let number = RichText::new(format!("{}", k + 1)).color(ThemePalette::of(ui).weak);
            ui.add_sized([16.0, CONTROL_HEIGHT], Label::new(number));
            from_right(ui, |ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                list_buttons(ui, project, k, intents);
                let name = RichText::new(entry.display_name());
                let name = match current.contains(&k) {
                    true => name.strong(),
                    false => name,
                };
                let label = Label::new(name).truncate().sense(Sense::click());
                let tip = format!("{}\nClick to go there.", entry.path.display());
                let left = Layout::left_to_right(Align::Center);
                let size = vec2(ui.available_width(), CONTROL_HEIGHT);
                let label = ui.allocate_ui_with_layout(size, left, |ui| ui.add(label));
                if label.inner.on_hover_text(tip).clicked() {
                    intents.push(Intent::Seek(k as f64));
                }
            });
        });
    }
    let mut closed = project.closed;
    let tip = "Continues from the last design to the first, so that the film can repeat forever.";
    toggle(ui, "Close the loop", tip, &mut closed);
    if closed != project.closed {
        intents.push(Intent::CloseLoop(closed));
    }
}

/// Draws the buttons of the design with the index `k` in the list, from right to left.
fn list_buttons(ui: &mut Ui, project: &Project, k: usize, intents: &mut Intents) {
    let last = project.designs.len() - 1;
    let mut button = |icon, tip: &str, order: Option<Vec<MovedDesigns>>| {
        ui.add_enabled_ui(order.is_some(), |ui| {
            if icon_button(ui, icon, tip, vec2(24.0, 24.0)).clicked() {
                intents.extend(order.map(Intent::ReorderDesigns));
            }
        });
    };
    let removed = (last > 1).then(|| project.without(k));
    button(icons::CLOSE, "Remove", removed);
    let duplicated = project.with_duplicated(k);
    button(icons::COPY, "Duplicate", Some(duplicated));
    let later = (k < last).then(|| project.with_moved(k, k + 2)).flatten();
    button(icons::DOWN, "Move down", later);
    let earlier = k.checked_sub(1).and_then(|to| project.with_moved(k, to));
    button(icons::UP, "Move up", earlier);
}

fn add(ui: &mut Ui, project: &Project, intents: &mut Intents) {
    let button = ui.button("Add designs …");
    let tip = "Adds designs after the last one. The film goes through all of them.";
    if button.on_hover_text(tip).clicked() {
        intents.push(Intent::AskInsert(project.designs.len()));
    }
    ui.add_space(4.0);
}

fn swap(ui: &mut Ui) -> bool {
    let tip = "Swap source and target: the film runs backwards.";
    icon_button(ui, icons::SWAP, tip, vec2(32.0, CONTROL_HEIGHT)).clicked()
}

/// Indices, role and colour of a design in the current segment.
struct DesignHeading {
    /// Index of the design among those of the segment.
    index: usize,
    /// Index of the design among all designs of the project.
    number: usize,
    /// Label of the design in the segment: "Source", "Target", or its number on a path.
    role: String,
    /// Fill colour of the design on the stage.
    colour: Rgb,
}

/// Draws the name and the settings of one design of the current segment.
fn design(ui: &mut Ui, heading: &DesignHeading, entry: &mut DesignEntry, intents: &mut Intents) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let (dot, _) = ui.allocate_exact_size(vec2(12.0, CONTROL_HEIGHT), Sense::hover());
        let [r, g, b] = heading.colour.0;
        let fill = Color32::from_rgb(r, g, b);
        ui.painter().circle_filled(dot.center(), 5.0, fill);
        ui.label(secondary_text(ui, &heading.role));
        from_right(ui, |ui| {
            let tip = "Replace file";
            if icon_button(ui, icons::OPEN, tip, vec2(24.0, 24.0)).clicked() {
                intents.push(Intent::AskReplace(heading.number));
            }
            let path = entry.path.display().to_string();
            ui.add(Label::new(entry.display_name()).truncate())
                .on_hover_text(path);
        });
    });
    let id = ui.id().with(("placement", heading.index));
    ui.push_id(id, |ui| {
        CollapsingHeader::new("Placement").show_unindented(ui, |ui| placement(ui, entry));
        if is_picture(entry) {
            CollapsingHeader::new("Image tracing")
                .show_unindented(ui, |ui| import_options(ui, entry));
        }
    });
}

/// Draws the silhouettes that can be read from a picture, as buttons of which the one in use is
/// marked. Draws nothing if there is no choice.
fn readings(ui: &mut Ui, index: usize, choices: &[ReadingChoice], reading: &mut PictureReading) {
    let Some(automatic) = choices.first() else {
        return;
    };
    let used = match *reading {
        PictureReading::Auto => automatic.reading,
        chosen => chosen,
    };
    let how = match *reading {
        PictureReading::Auto => "chosen automatically",
        _ => "chosen by you",
    };
    let text = format!(
        "Silhouette read by {} ({how}). Click another one to use it:",
        used.name().title.to_lowercase()
    );
    hint(ui, &text);
    ui.horizontal(|ui| {
        for choice in choices {
            let salt = ("reading", index, choice.reading.name().key);
            if reading_button(ui, salt, choice, choice.reading == used) {
                *reading = choice.reading;
            }
        }
    });
    ui.add_space(GRID);
}

/// Side of the picture of a silhouette, in points.
const READING_SIDE: f32 = 64.0;

/// Draws the picture and the name of a silhouette; returns whether it was clicked.
fn reading_button(
    ui: &mut Ui,
    salt: (&str, usize, &str),
    choice: &ReadingChoice,
    is_used: bool,
) -> bool {
    let name = choice.reading.name();
    let line = ui.text_style_height(&TextStyle::Small);
    let size = vec2(READING_SIDE + GRID, READING_SIDE + line + GRID);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, true, is_used, name.title)
    });
    let palette = ThemePalette::of(ui);
    let (fill, outline) = match (is_used, response.hovered()) {
        (true, _) => (palette.accent_fill, palette.accent),
        (false, true) => (palette.hover, palette.line),
        (false, false) => (palette.raised, palette.line),
    };
    ui.painter()
        .rect(rect, RADIUS, fill, (1.0, outline), StrokeKind::Inside);
    let place = Rect::from_min_size(
        rect.min + vec2(0.5 * GRID, 0.5 * GRID),
        vec2(READING_SIDE, READING_SIDE),
    );
    let id = ui.id().with(salt);
    let texture = texture(ui.ctx(), id, &choice.image, u32::MAX);
    let full_uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    ui.painter()
        .image(texture.id(), place, full_uv, Color32::WHITE);
    let at = rect.center_bottom() - vec2(0.0, 2.0);
    ui.painter()
        .text(at, Align2::CENTER_BOTTOM, name.title, SMALL, palette.text);
    response.on_hover_text(name.sentence).clicked()
}

/// Draws the import notes of a design: reports of repairs and of ignored content.
fn notes(ui: &mut Ui, index: usize, notes: &[ImportNote]) {
    let title = match notes {
        [] => return,
        [_] => "1 import note".to_owned(),
        notes => format!("{} import notes", notes.len()),
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
        "Moves this design right (x) and up (y), in its own units.",
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
    let tip = "Scales this design about its centre.";
    slider(ui, "Scale", tip, &mut place.scale, SCALE_RANGE, true);
    let mut degrees = place.rotation.to_degrees();
    let tip = "Rotates this design counter-clockwise, in degrees.";
    slider(ui, "Rotation", tip, &mut degrees, -180.0..=180.0, false);
    // The conversion to degrees and back is inexact. Without this test, drawing the slider would
    // change the project.
    if (degrees - place.rotation.to_degrees()).abs() > 1e-9 {
        place.rotation = degrees.to_radians();
    }
    let tip = "Flips this design horizontally.";
    toggle(ui, "Flip", tip, &mut place.mirror);
}

fn is_picture(entry: &DesignEntry) -> bool {
    Format::PICTURES
        .iter()
        .any(|format| format.matches_extension(&entry.path))
}

fn import_options(ui: &mut Ui, entry: &mut DesignEntry) {
    let import = &mut entry.import;
    let tip = "Turns each flat colour of the picture into a part of its own, in that colour.";
    toggle(ui, "By colour", tip, &mut import.colours);
    let tip = "Finds the grey level that separates shape from background automatically.";
    automatic_toggle(
        ui,
        "Auto threshold",
        tip,
        &mut import.threshold,
        MIDDLE_GREY,
    );
    if let Some(threshold) = &mut import.threshold {
        let level = drag_value(threshold, 1..=255, 0.5, 0);
        let tip = "Grey level that separates shape from background, 1 to 255. Higher values add \
                   more to the shape.";
        number(ui, "Threshold", tip, level);
    }
    let tip = "Swaps shape and background.";
    toggle(ui, "Invert", tip, &mut import.invert);
    let min_area = DragValue::new(&mut import.specks_px).speed(0.2);
    let tip = "Ignores spots and holes with fewer pixels than this.";
    number(ui, "Ignore spots", tip, min_area);
    let tolerance = drag_value(&mut import.tolerance, 0.0..=0.1, 0.0001, 4);
    let tip = "Maximum distance between the traced outline and the exact edge, as a fraction of \
               the longer side. Larger values give fewer corners.";
    number(ui, "Tolerance", tip, tolerance);
    ui.add_space(GRID);
}
