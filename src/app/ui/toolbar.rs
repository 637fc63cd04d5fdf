//! Toolbar at the top of the window: name of the program, title of the project, and buttons for
//! files, undo and redo, export, presentation, views, theme and help.

use bevy_egui::egui::{self, Align, Color32, Layout, Margin, Panel, Rect, RichText, Ui, vec2};

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::{ExportKind, Intent};
use crate::app::input::preferences::{Preferences, ThemeChoice};
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, intent_button, secondary_text};
use crate::app::ui::ui_state::{Intents, UiState};

/// Height of the toolbar, in points.
const HEIGHT: f32 = 48.0;

/// Width reserved for the word “edited” after the project's title, in points.
const EDITED_WIDTH: f32 = 56.0;

/// Draws the toolbar at the top of the window.
pub fn show(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = egui::Frame::new()
        .fill(ThemePalette::of(root).panel)
        .inner_margin(Margin::symmetric(16, 8));
    Panel::top("toolbar")
        .exact_size(HEIGHT)
        .frame(frame)
        .show(root, |ui| {
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                logo(ui);
                ui.label(RichText::new("Morphospace").heading());
                ui.add_space(2.0 * GRID);
                from_right(ui, |ui| {
                    buttons(ui, state, intents);
                    ui.add_space(GRID);
                    // The title gets the remaining space.
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| title(ui, state));
                });
            });
        });
}

/// Draws the logo: a disc that becomes a square.
fn logo(ui: &mut Ui) {
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

fn title(ui: &mut Ui, state: &UiState) {
    let is_edited = state.session.is_dirty();
    ui.scope(|ui| {
        let reserved = if is_edited { EDITED_WIDTH } else { 0.0 };
        ui.set_max_width((ui.available_width() - reserved).max(0.0));
        ui.add(egui::Label::new(state.session.title()).truncate());
    });
    if is_edited {
        ui.label(secondary_text(ui, "edited"))
            .on_hover_text("Unsaved changes. Save with Ctrl S.");
    }
}

fn buttons(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    ui.spacing_mut().item_spacing.x = 4.0;
    if ui
        .button("?")
        .on_hover_text("Keyboard shortcuts (? or F1)")
        .clicked()
    {
        intents.push(Intent::ToggleHelp);
    }
    theme_button(ui, state, intents);
    let tip = "Fit to view (Z)";
    intent_button(ui, icons::FIT, tip, Intent::FitView, intents);
    ui.add_space(GRID);
    let accent = ThemePalette::of(ui).accent;
    let tip = "Compare with a second method (V)";
    let icon = icons::COMPARE.with_colour(state.comparison.is_shown.then_some(accent));
    intent_button(ui, icon, tip, Intent::ToggleComparison, intents);
    let tip = "Map of all designs (D)";
    let icon = icons::MAP.with_colour(state.map.is_shown.then_some(accent));
    intent_button(ui, icon, tip, Intent::ToggleMap, intents);
    let tip = "Graphs over time (P)";
    let icon = icons::PLOT.with_colour(state.preferences.plots.then_some(accent));
    intent_button(ui, icon, tip, Intent::TogglePlots, intents);
    match_button(ui, state, intents);
    ui.add_space(GRID);
    capture_buttons(ui, state, intents);
    ui.add_space(GRID);
    history_buttons(ui, state, intents);
    ui.add_space(GRID);
    let tip = "Save project (Ctrl S)";
    intent_button(ui, icons::SAVE, tip, Intent::Save, intents);
    let tip = "Open a project or designs (Ctrl O)";
    intent_button(ui, icons::OPEN, tip, Intent::AskOpen, intents);
}

/// Draws the buttons for export and presentation, from right to left.
fn capture_buttons(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let options = Preferences {
        film_options: !state.preferences.film_options,
        ..*state.preferences
    };
    let ink = state
        .preferences
        .film_options
        .then_some(ThemePalette::of(ui).accent);
    let tip = "Export settings";
    intent_button(
        ui,
        icons::MORE.with_colour(ink),
        tip,
        Intent::SetPreferences(options),
        intents,
    );
    let tip = "Present: only the drawing, from the first stop (F5)";
    let talk = Intent::Present { is_all: false };
    intent_button(ui, icons::PRESENT, tip, talk, intents);
    let tip = "Export film (G)";
    let icon = icons::RECORD.with_colour(Some(ThemePalette::of(ui).problem));
    intent_button(ui, icon, tip, Intent::AskExport(ExportKind::Film), intents);
    let tip = "Save image (S); with panels: Shift S";
    let picture = Intent::Screenshot { with_panels: false };
    intent_button(ui, icons::CAMERA, tip, picture, intents);
}

fn match_button(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let is_enabled = state.session.has_match_editor();
    let tip = if is_enabled {
        "Edit match: pair points of source and target, side by side (E)"
    } else {
        "Not available: designs with triangles or bars of their own have nothing to match"
    };
    let ink = state.editor.is_open.then_some(ThemePalette::of(ui).accent);
    let icon = icons::MATCH.with_colour(ink);
    ui.add_enabled_ui(is_enabled, |ui| {
        intent_button(ui, icon, tip, Intent::Editor(EditorAction::Toggle), intents);
    });
}

/// Draws the buttons for redo and undo, from right to left.
fn history_buttons(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    ui.add_enabled_ui(state.session.can_redo(), |ui| {
        let tip = "Redo (Ctrl Shift Z or Ctrl Y)";
        intent_button(ui, icons::REDO, tip, Intent::Redo, intents);
    });
    ui.add_enabled_ui(state.session.can_undo(), |ui| {
        let tip = "Undo (Ctrl Z)";
        intent_button(ui, icons::UNDO, tip, Intent::Undo, intents);
    });
}

fn theme_button(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let (icon, theme, tip) = match state.preferences.theme {
        ThemeChoice::Dark => (icons::SUN, ThemeChoice::Light, "Light theme"),
        ThemeChoice::Light => (icons::MOON, ThemeChoice::Dark, "Dark theme"),
    };
    let toggled = Preferences {
        theme,
        ..*state.preferences
    };
    intent_button(ui, icon, tip, Intent::SetPreferences(toggled), intents);
}
