//! Buttons and numbers of the timeline: play, where t is, and how a pass runs.

use bevy_egui::egui::{self, DragValue, Response, RichText, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::playback::player::SPEEDS;
use crate::app::ui::kit::easing_editor;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{
    choice_button, from_right, intent_button, secondary_text, with_tooltip,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::settings::choice::Choice;
use crate::transition::{PlayMode, Timing};

const ROW_HEIGHT: f32 = 36.0;

/// The longest pass and hold that the window offers, in seconds.
const LONGEST_SECS: f64 = 600.0;

/// Draws the row above the track.
pub fn show(ui: &mut Ui, scene: &UiState, timing: &mut Timing, acts: &mut Intents) {
    ui.allocate_ui(vec2(ui.available_width(), ROW_HEIGHT), |ui| {
        ui.horizontal_centered(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            buttons(ui, scene, acts);
            ui.add_space(GRID);
            place(ui, scene, acts);
            from_right(ui, |ui| pass(ui, scene, timing, acts));
        });
    });
}

fn buttons(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let tip = "Start of the pass (Home)";
    intent_button(ui, icons::TO_START, tip, Intent::SeekStart, acts);
    let tip = "Play back to the stop before and wait (Page Up)";
    let back = Intent::PlayToPreviousStop;
    intent_button(ui, icons::PREVIOUS_STOP, tip, back, acts);
    if play_button(ui, scene).clicked() {
        acts.push(Intent::TogglePlay);
    }
    let tip = "Play to the next stop and wait (Page Down)";
    intent_button(ui, icons::NEXT_STOP, tip, Intent::PlayToNextStop, acts);
    let tip = "End of the pass (End)";
    intent_button(ui, icons::TO_END, tip, Intent::SeekEnd, acts);
    let tip = "Set a stop here (M)";
    intent_button(ui, icons::ADD_STOP, tip, Intent::AddStop, acts);
}

fn play_button(ui: &mut Ui, scene: &UiState) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(36.0, 36.0), egui::Sense::click());
    let icon = match (scene.playback.is_playing(), scene.playback.is_backwards()) {
        (true, _) => icons::PAUSE,
        (false, false) => icons::PLAY,
        (false, true) => icons::PLAY_BACKWARDS,
    };
    let (fill, ink) = if response.hovered() {
        (palette.accent, palette.panel)
    } else {
        (palette.accent_ground, palette.text)
    };
    ui.painter().circle_filled(rect.center(), 17.0, fill);
    icons::paint_icon(ui.painter(), icon, rect, ink);
    with_tooltip(response, "Play or pause (Space); play the other way (R)")
}

fn place(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let palette = ThemePalette::of(ui);
    ui.label(RichText::new("t").color(palette.weak));
    let mut t = scene.playback.t();
    let number = DragValue::new(&mut t)
        .speed(0.002)
        .fixed_decimals(3)
        .update_while_editing(false);
    let tip = "Where the transition is: 0 is the source, 1 the target. Click to type, drag to \
               move; values below 0 and above 1 extrapolate.";
    let response = with_tooltip(ui.add_sized([72.0, CONTROL_HEIGHT], number), tip);
    if response.changed() {
        acts.push(Intent::Seek(t));
    }
    // In words too: what is beyond is not told by colour alone.
    let beyond = match scene.playback.t() {
        t if t < 0.0 => "extrapolated before the source",
        t if t > scene.session.leg_count() as f64 => "extrapolated beyond the target",
        _ => return,
    };
    ui.label(RichText::new(beyond).small().color(palette.amber));
}

/// From right to left.
fn pass(ui: &mut Ui, scene: &UiState, timing: &mut Timing, acts: &mut Intents) {
    ui.spacing_mut().item_spacing.x = 4.0;
    speed(ui, scene, acts);
    caption(ui, "Speed");
    let tip = "Waits so long at either end of a pass.";
    seconds(ui, &mut timing.hold_secs, 0.0, tip);
    caption(ui, "Hold");
    let tip = "How long one pass takes, without the holds.";
    seconds(ui, &mut timing.duration_secs, 0.1, tip);
    caption(ui, "Lasts");
    let easing = easing_editor::menu(ui, "easing", &mut timing.easing, 88.0);
    with_tooltip(
        easing,
        "How t speeds up and slows down from stop to stop; a stop may say otherwise (right-click).",
    );
    ui.add_space(GRID);
    for mode in PlayMode::ALL {
        let width = if mode == PlayMode::PingPong {
            72.0
        } else {
            48.0
        };
        let name = mode.name();
        let tip = format!("{} (L)", name.sentence);
        if choice_button(ui, timing.play == mode, name.title, &tip, width) {
            timing.play = mode;
        }
    }
}

fn caption(ui: &mut Ui, text: &str) {
    ui.label(secondary_text(ui, text));
    ui.add_space(4.0);
}

fn seconds(ui: &mut Ui, value: &mut f64, least: f64, tip: &str) {
    let number = DragValue::new(value)
        .speed(0.02)
        .range(least..=LONGEST_SECS)
        .clamp_existing_to_range(false)
        .max_decimals(2)
        .suffix(" s")
        .update_while_editing(false);
    with_tooltip(ui.add_sized([60.0, CONTROL_HEIGHT], number), tip);
}

fn speed(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let current = scene.playback.speed();
    let list = egui::ComboBox::from_id_salt("speed")
        .width(64.0)
        .selected_text(format!("{current}×"));
    let shown = list.show_ui(ui, |ui| {
        for speed in SPEEDS {
            if ui
                .selectable_label(speed == current, format!("{speed}×"))
                .clicked()
            {
                acts.push(Intent::Speed(speed));
            }
        }
    });
    let tip = "Speed of playing only ([ and ]); Backspace is 1. Recordings keep the duration.";
    with_tooltip(shown.response, tip);
}
