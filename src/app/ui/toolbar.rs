//! The line at the top: whose window this is, what is open, and what can be done with it.

use bevy_egui::egui::{self, Align, Color32, Layout, Margin, Panel, Rect, RichText, Ui, vec2};

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::{Preferences, ThemeChoice};
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, intent_button, secondary_text};
use crate::app::ui::ui_state::{Intents, UiState};

const HEIGHT: f32 = 48.0;

/// What the word beside the title of an edited project takes.
const EDITED: f32 = 56.0;

/// Draws the toolbar.
pub fn show(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let frame = egui::Frame::new()
        .fill(ThemePalette::of(root).panel)
        .inner_margin(Margin::symmetric(16, 8));
    Panel::top("toolbar")
        .exact_size(HEIGHT)
        .frame(frame)
        .show(root, |ui| {
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                mark(ui);
                ui.label(RichText::new("Morphospace").heading());
                ui.add_space(2.0 * GRID);
                from_right(ui, |ui| {
                    buttons(ui, scene, acts);
                    ui.add_space(GRID);
                    // In what the buttons leave.
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| title(ui, scene));
                });
            });
        });
}

/// The sign of the program: a disc on its way to a square.
fn mark(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(40.0, 24.0), egui::Sense::hover());
    let ends = [
        Color32::from_rgb(0x3b, 0x7d, 0xd8),
        Color32::from_rgb(0xe0, 0x8a, 0x2b),
    ];
    let steps = [
        (0.0, 9.0, ends[0]),
        (0.5, 6.0, ends[0].lerp_to_gamma(ends[1], 0.5)),
        (1.0, 2.0, ends[1]),
    ];
    for (t, radius, colour) in steps {
        let centre = rect.left_center() + vec2(9.0 + 22.0 * t, 0.0);
        let square = Rect::from_center_size(centre, vec2(18.0, 18.0));
        ui.painter()
            .rect_filled(square, radius, colour.gamma_multiply(0.85));
    }
}

fn title(ui: &mut Ui, scene: &UiState) {
    let is_edited = scene.session.is_dirty();
    ui.scope(|ui| {
        let beside = if is_edited { EDITED } else { 0.0 };
        ui.set_max_width((ui.available_width() - beside).max(0.0));
        ui.add(egui::Label::new(scene.session.title()).truncate());
    });
    if is_edited {
        ui.label(secondary_text(ui, "edited"))
            .on_hover_text("Has changes that are not saved yet. Ctrl S saves them.");
    }
}

fn buttons(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    ui.spacing_mut().item_spacing.x = 4.0;
    if ui.button("?").on_hover_text("All keys (? or F1)").clicked() {
        acts.push(Intent::ToggleHelp);
    }
    theme_button(ui, scene, acts);
    let tip = "Show the whole transition (Z)";
    intent_button(ui, icons::FIT, tip, Intent::FitView, acts);
    ui.add_space(GRID);
    let accent = ThemePalette::of(ui).accent;
    let tip = "A second method beside the stage (V)";
    let icon = icons::COMPARE.inked(scene.twin.is_shown.then_some(accent));
    intent_button(ui, icon, tip, Intent::ToggleTwin, acts);
    let tip = "The map of all designs (D)";
    let icon = icons::MAP.inked(scene.map.is_shown.then_some(accent));
    intent_button(ui, icon, tip, Intent::ToggleMap, acts);
    let tip = "Plots of the measures against t (P)";
    let icon = icons::PLOT.inked(scene.preferences.plots.then_some(accent));
    intent_button(ui, icon, tip, Intent::TogglePlots, acts);
    match_button(ui, scene, acts);
    ui.add_space(GRID);
    capture_buttons(ui, scene, acts);
    ui.add_space(GRID);
    history_buttons(ui, scene, acts);
    ui.add_space(GRID);
    let tip = "Save the project (Ctrl S)";
    intent_button(ui, icons::SAVE, tip, Intent::Save, acts);
    let tip = "Open a project, or one or two designs (Ctrl O)";
    intent_button(ui, icons::OPEN, tip, Intent::AskOpen, acts);
}

/// From right to left.
fn capture_buttons(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let options = Preferences {
        film_options: !scene.preferences.film_options,
        ..*scene.preferences
    };
    let ink = scene
        .preferences
        .film_options
        .then_some(ThemePalette::of(ui).accent);
    let tip = "Shape, size and kind of pictures and films";
    intent_button(
        ui,
        icons::MORE.inked(ink),
        tip,
        Intent::Prefer(options),
        acts,
    );
    let tip = "Present: nothing but the drawing, from the first stop (F5)";
    let talk = Intent::Present { is_all: false };
    intent_button(ui, icons::PRESENT, tip, talk, acts);
    let tip = "Record one pass as a film, in the background (G)";
    let icon = icons::RECORD.inked(Some(ThemePalette::of(ui).problem));
    intent_button(ui, icon, tip, Intent::Record, acts);
    let tip = "Picture of the stage (S); with the panels: Shift S";
    let picture = Intent::Screenshot { with_panels: false };
    intent_button(ui, icons::CAMERA, tip, picture, acts);
}

fn match_button(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let can = scene.session.can_match();
    let tip = if can {
        "Which point is which: source and target side by side (E)"
    } else {
        "Not available: there is nothing to match in designs that have triangles or bars of their \
         own"
    };
    let ink = scene.editor.is_open.then_some(ThemePalette::of(ui).accent);
    let icon = icons::MATCH.inked(ink);
    ui.add_enabled_ui(can, |ui| {
        intent_button(ui, icon, tip, Intent::Editor(EditorAction::Toggle), acts);
    });
}

/// From right to left.
fn history_buttons(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    ui.add_enabled_ui(scene.session.can_redo(), |ui| {
        let tip = "Make the change again that was undone (Ctrl Shift Z or Ctrl Y)";
        intent_button(ui, icons::REDO, tip, Intent::Redo, acts);
    });
    ui.add_enabled_ui(scene.session.can_undo(), |ui| {
        let tip = "Undo the last change (Ctrl Z)";
        intent_button(ui, icons::UNDO, tip, Intent::Undo, acts);
    });
}

fn theme_button(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let (icon, theme, tip) = match scene.preferences.theme {
        ThemeChoice::Dark => (icons::SUN, ThemeChoice::Light, "Light panels"),
        ThemeChoice::Light => (icons::MOON, ThemeChoice::Dark, "Dark panels"),
    };
    let other = Preferences {
        theme,
        ..*scene.preferences
    };
    intent_button(ui, icon, tip, Intent::Prefer(other), acts);
}
