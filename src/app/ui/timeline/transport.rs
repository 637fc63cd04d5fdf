//! Playback controls of the timeline: buttons, a field with the current t, and the timing of the
//! film.

use bevy_egui::egui::{self, DragValue, Response, RichText, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::playback::player::SPEEDS;
use crate::app::ui::kit::easing_editor;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{
    from_right, intent_button, secondary_text, segment_button, with_tooltip,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::settings::Choice;
use crate::transition::{PlayMode, Timing};

/// Height of the row of playback controls, in points.
const ROW_HEIGHT: f32 = 36.0;

/// Maximum duration and maximum pause of a film that can be set in the window, in seconds.
const MAX_SECS: f64 = 600.0;

/// Draws the row of playback controls above the track; changes `timing`.
pub fn show(ui: &mut Ui, state: &UiState, timing: &mut Timing, intents: &mut Intents) {
    ui.allocate_ui(vec2(ui.available_width(), ROW_HEIGHT), |ui| {
        ui.horizontal_centered(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            buttons(ui, state, intents);
            ui.add_space(GRID);
            time_field(ui, state, intents);
            from_right(ui, |ui| timing_controls(ui, state, timing, intents));
        });
    });
}

fn buttons(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let tip = "Go to start (Home)";
    intent_button(ui, icons::TO_START, tip, Intent::SeekStart, intents);
    let tip = "Play backwards to the previous stop (Page Up)";
    let previous = Intent::PlayToPreviousStop;
    intent_button(ui, icons::PREVIOUS_STOP, tip, previous, intents);
    if play_button(ui, state).clicked() {
        intents.push(Intent::TogglePlay);
    }
    let tip = "Play to the next stop (Page Down)";
    intent_button(ui, icons::NEXT_STOP, tip, Intent::PlayToNextStop, intents);
    let tip = "Go to end (End)";
    intent_button(ui, icons::TO_END, tip, Intent::SeekEnd, intents);
    let tip = "Add a stop here (M)";
    intent_button(ui, icons::ADD_STOP, tip, Intent::AddStop, intents);
}

fn play_button(ui: &mut Ui, state: &UiState) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(36.0, 36.0), egui::Sense::click());
    let icon = match (state.playback.is_playing(), state.playback.is_backwards()) {
        (true, _) => icons::PAUSE,
        (false, false) => icons::PLAY,
        (false, true) => icons::PLAY_BACKWARDS,
    };
    let (fill, ink) = if response.hovered() {
        (palette.accent, palette.panel)
    } else {
        (palette.accent_fill, palette.text)
    };
    ui.painter().circle_filled(rect.center(), 17.0, fill);
    icons::paint_icon(ui.painter(), icon, rect, ink);
    with_tooltip(response, "Play or pause (Space); reverse (R)")
}

fn time_field(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let palette = ThemePalette::of(ui);
    ui.label(RichText::new("t").color(palette.weak));
    let mut t = state.playback.t();
    let number = DragValue::new(&mut t)
        .speed(0.002)
        .fixed_decimals(3)
        .update_while_editing(false);
    let tip = "Current moment: 0 is the source, 1 the target. Click to type, drag to change. Below \
               0 and above 1 the motion is extrapolated.";
    let response = with_tooltip(ui.add_sized([72.0, CONTROL_HEIGHT], number), tip);
    if response.changed() {
        intents.push(Intent::Seek(t));
    }
    // A text says that t is outside the film, because a change of the colour alone is not enough.
    let range_text = match state.playback.t() {
        t if t < 0.0 => "before the source",
        t if t > state.session.segment_count() as f64 => "beyond the target",
        _ => return,
    };
    ui.label(RichText::new(range_text).small().color(palette.amber));
}

/// Draws the controls of speed, timing and play mode, from right to left.
fn timing_controls(ui: &mut Ui, state: &UiState, timing: &mut Timing, intents: &mut Intents) {
    ui.spacing_mut().item_spacing.x = 4.0;
    speed(ui, state, intents);
    caption(ui, "Speed");
    let tip = "Pause at each end of the film";
    seconds(ui, &mut timing.hold_secs, 0.0, tip);
    caption(ui, "Pause");
    let tip = "Duration of the film from start to end, without pauses";
    seconds(ui, &mut timing.duration_secs, 0.1, tip);
    caption(ui, "Duration");
    let easing = easing_editor::menu(ui, "easing", &mut timing.easing, 88.0);
    with_tooltip(
        easing,
        "Easing between stops. Right-click a stop to give it an easing of its own.",
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
        if segment_button(ui, timing.play == mode, name.title, &tip, width) {
            timing.play = mode;
        }
    }
}

fn caption(ui: &mut Ui, text: &str) {
    ui.label(secondary_text(ui, text));
    ui.add_space(4.0);
}

fn seconds(ui: &mut Ui, value: &mut f64, min_secs: f64, tip: &str) {
    let number = DragValue::new(value)
        .speed(0.02)
        .range(min_secs..=MAX_SECS)
        .clamp_existing_to_range(false)
        .max_decimals(2)
        .suffix(" s")
        .update_while_editing(false);
    with_tooltip(ui.add_sized([52.0, CONTROL_HEIGHT], number), tip);
}

fn speed(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let current = state.playback.speed();
    let list = egui::ComboBox::from_id_salt("speed")
        .width(64.0)
        .selected_text(format!("{current}×"));
    let shown = list.show_ui(ui, |ui| {
        for speed in SPEEDS {
            if ui
                .selectable_label(speed == current, format!("{speed}×"))
                .clicked()
            {
                intents.push(Intent::SetSpeed(speed));
            }
        }
    });
    let tip = "Playback speed ([ and ]; Backspace resets it). Exports keep the film's duration.";
    with_tooltip(shown.response, tip);
}
