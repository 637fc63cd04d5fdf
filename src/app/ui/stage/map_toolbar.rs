//! What can be chosen above the map: how the designs are laid out, what lies under them, what the
//! hand does; and how they are blended.

use bevy_egui::egui::{ComboBox, Label, Panel, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons::{self, Icon};
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{choices, icon_button, panel_frame, secondary_text};
use crate::app::ui::stage::checks::capitalised;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::MapMeasure;
use crate::settings::choice::Choice;
use crate::space::MapLayout;

/// Width of the row of layouts.
const LAYOUTS: f32 = 288.0;

/// Draws what can be chosen above both.
pub fn strip(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
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
                let now = scene.session.whole().map(|whole| whole.map.layout);
                let mut layout = now.unwrap_or_default();
                let before = layout;
                ui.allocate_ui(vec2(LAYOUTS, CONTROL_HEIGHT), |ui| {
                    choices(ui, &mut layout, &all.collect::<Vec<_>>());
                });
                if layout != before {
                    acts.push(Intent::LayOut(layout));
                }
                ui.add_space(GRID);
                measures(ui, scene, acts);
                tools(ui, scene, acts);
                ui.add_space(GRID);
                let told = told(scene);
                ui.add(Label::new(secondary_text(ui, told.as_str())).truncate())
                    .on_hover_text(told);
            });
        });
}

/// Which measure has its contours under the map.
fn measures(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let named = |shown: Option<MapMeasure>| shown.map_or("No contours", |m| m.name().title);
    let mut shown = scene.map.shown;
    let all = MapMeasure::CHOICES.iter().copied().map(Some);
    let list = ComboBox::from_id_salt("contours").selected_text(named(shown));
    list.width(112.0).show_ui(ui, |ui| {
        for measure in std::iter::once(None).chain(all) {
            let tip = measure.map_or("What lies between the designs, and nothing else", |m| {
                m.name().sentence
            });
            ui.selectable_value(&mut shown, measure, named(measure))
                .on_hover_text(tip);
        }
    });
    if shown != scene.map.shown {
        acts.push(Intent::ShowMeasure(shown));
    }
}

/// What the hand draws, and what is kept.
fn tools(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let accent = ThemePalette::of(ui).accent;
    let size = vec2(32.0, CONTROL_HEIGHT);
    let mut tool = |icon: Icon, is_on: bool, tip: &str, intent: Intent| {
        if icon_button(ui, icon.inked(is_on.then_some(accent)), tip, size).clicked() {
            acts.push(intent);
        }
    };
    let draws = scene.map.draws_path;
    let tip = "Draw a path (E): a click sets a stop, dragging draws the way to the next";
    tool(icons::PATH, draws, tip, Intent::DrawPath(!draws));
    let tip = "Record the way of the puck as the path (W)";
    tool(
        icons::RECORD,
        scene.map.is_recording(),
        tip,
        Intent::RecordPath,
    );
    tool(
        icons::STAR,
        false,
        "Keep the blend under the puck (K)",
        Intent::Keep,
    );
}

/// How the designs are blended, in a few words.
fn told(scene: &UiState) -> String {
    match scene.map.made() {
        _ if scene.map.is_busy() => "Working …".to_owned(),
        Some(made) => {
            let space = made.space();
            let note = space.notes().iter().map(ToString::to_string).next();
            let how = match space.family() {
                Some(family) => format!(
                    "Rigid parts, one mesh of {} vertices",
                    family.places()[0].len()
                ),
                None if space.is_of_pictures() => "Pictures".to_owned(),
                None => "Distance fields".to_owned(),
            };
            note.map_or(how, |note| capitalised(&note))
        }
        None => String::new(),
    }
}
