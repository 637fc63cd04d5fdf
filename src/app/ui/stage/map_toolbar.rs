//! Toolbar above the map: choice of the layout and of the contours, tools for paths and saved
//! blends, and a text that says how the designs are blended.

use bevy_egui::egui::{ComboBox, Label, Panel, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons::{self, Icon};
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{icon_button, panel_frame, secondary_text, segmented_control};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::MapMeasure;
use crate::settings::Choice;
use crate::space::{MapLayout, SpaceNote};

/// Width of the buttons that choose the layout of the map, in points.
const LAYOUTS_WIDTH: f32 = 288.0;

/// Draws the toolbar of the map.
pub fn strip(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = panel_frame(root, [16, 16, 4, 4]);
    Panel::top("map")
        .exact_size(CONTROL_HEIGHT + GRID)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            ui.horizontal_centered(|ui| {
                let all = MapLayout::CHOICES.iter().map(|&layout| {
                    let name = layout.name();
                    (layout, name.title, name.sentence)
                });
                let current = state.session.whole_project().map(|whole| whole.map.layout);
                let mut layout = current.unwrap_or_default();
                let before = layout;
                ui.allocate_ui(vec2(LAYOUTS_WIDTH, CONTROL_HEIGHT), |ui| {
                    segmented_control(ui, &mut layout, &all.collect::<Vec<_>>());
                });
                if layout != before {
                    intents.push(Intent::SetMapLayout(layout));
                }
                ui.add_space(GRID);
                measures(ui, state, intents);
                tools(ui, state, intents);
                ui.add_space(GRID);
                let status = status(state);
                ui.add(Label::new(secondary_text(ui, status.as_str())).truncate())
                    .on_hover_text(status);
            });
        });
}

/// Draws the drop-down list of the measures, such as area, whose contours the map can show.
fn measures(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let measure_name =
        |measure: Option<MapMeasure>| measure.map_or("No contours", |m| m.name().title);
    let mut selected = state.map.measure;
    let all = MapMeasure::CHOICES.iter().copied().map(Some);
    let list = ComboBox::from_id_salt("contours").selected_text(measure_name(selected));
    list.width(112.0).show_ui(ui, |ui| {
        for measure in std::iter::once(None).chain(all) {
            let tip = measure.map_or("Only the blends between the designs", |m| m.name().sentence);
            ui.selectable_value(&mut selected, measure, measure_name(measure))
                .on_hover_text(tip);
        }
    });
    if selected != state.map.measure {
        intents.push(Intent::ShowMapMeasure(selected));
    }
}

/// Draws the buttons for drawing a path, for recording the marker's movement as a path, and for
/// saving a blend.
fn tools(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let accent = ThemePalette::of(ui).accent;
    let size = vec2(32.0, CONTROL_HEIGHT);
    let mut tool = |icon: Icon, is_on: bool, tip: &str, intent: Intent| {
        if icon_button(ui, icon.with_colour(is_on.then_some(accent)), tip, size).clicked() {
            intents.push(intent);
        }
    };
    let is_drawing = state.map.is_drawing_path;
    let tip = "Draw a path (E): click to add a stop, drag to draw the way to the next stop";
    tool(
        icons::PATH,
        is_drawing,
        tip,
        Intent::SetPathDrawing(!is_drawing),
    );
    let tip = "Record the marker's movement as a path (W)";
    tool(
        icons::RECORD,
        state.map.is_recording(),
        tip,
        Intent::TogglePathRecording,
    );
    tool(icons::STAR, false, "Save this blend (K)", Intent::SaveBlend);
}

/// Returns a text that says how the designs are blended, or the first note about their blending.
fn status(state: &UiState) -> String {
    match state.map.pictures() {
        _ if state.map.is_busy() => "Computing …".to_owned(),
        Some(pictures) => {
            let space = pictures.space();
            // The map shows the designs' paints, unlike the blends that are exported from it.
            let notes = space.notes().iter();
            let mut notes = notes.filter(|note| !matches!(note, SpaceNote::PaintIgnored));
            let note = notes.next().map(ToString::to_string);
            let kind = match space.family() {
                Some(family) => format!(
                    "Rigid parts, one mesh of {} vertices",
                    family.embeddings()[0].len()
                ),
                None if space.is_of_pictures() => "Pictures".to_owned(),
                None => "Distance fields".to_owned(),
            };
            note.map_or(kind, |note| capitalised(&note))
        }
        None => String::new(),
    }
}
