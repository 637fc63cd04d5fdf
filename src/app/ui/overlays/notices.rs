//! Notices at the lower edge of the stage, as cards with buttons to close them and to act on them.

use std::path::Path;

use bevy_egui::egui::{self, Align2, Context, Label, Order, Rect, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::notices::{Notice, NoticeKind, NoticeTopic};
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{card, fixed_layer, icon_button};
use crate::app::ui::ui_state::{Intents, UiState};

/// Maximum number of notices that are shown at once; older notices reappear when newer ones are
/// closed (resource limit: room on the stage).
const MAX_SHOWN: usize = 4;

/// Draws the newest notices at the lower edge of `stage`.
pub fn show(ctx: &Context, state: &UiState, stage: Rect, intents: &mut Intents) {
    let list = state.notices.list();
    if list.is_empty() {
        return;
    }
    let width = (stage.width() - 4.0 * GRID).clamp(160.0, 480.0);
    let at = stage.center_bottom() - vec2(0.0, 2.0 * GRID);
    // Notices may be errors, so they lie above the cards that show the progress of jobs.
    let area = fixed_layer("notices", Align2::CENTER_BOTTOM, at).order(Order::Foreground);
    area.show(ctx, |ui| {
        for notice in &list[list.len().saturating_sub(MAX_SHOWN)..] {
            let exceeds_limits = exceeds_limits(state, notice);
            message(ui, notice, exceeds_limits, width, intents);
        }
    });
}

/// Returns whether the notice reports that a transition was not built because the build would take
/// too long or too much memory.
fn exceeds_limits(state: &UiState, notice: &Notice) -> bool {
    let problem = state.session.problem();
    notice.kind == NoticeKind::Problem(NoticeTopic::Transition)
        && problem.is_some_and(TransitionProblem::exceeds_limits)
}

fn message(ui: &mut Ui, notice: &Notice, exceeds_limits: bool, width: f32, intents: &mut Intents) {
    let palette = ThemePalette::of(ui);
    let (icon, colour) = match notice.kind {
        NoticeKind::Problem(_) => (icons::WARNING, palette.problem),
        NoticeKind::Confirmation | NoticeKind::FileWritten => (icons::TICK, palette.accent),
        NoticeKind::Note => (icons::WARNING, palette.amber),
    };
    card(ui, egui::Margin::symmetric(12, 8), |ui| {
        ui.set_width(width);
        ui.horizontal_top(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(24.0, 24.0), egui::Sense::hover());
            icons::paint_icon(ui.painter(), icon, rect, colour);
            let text_width = width - 24.0 - 24.0 - 2.0 * GRID;
            ui.allocate_ui(vec2(text_width, 0.0), |ui| {
                ui.set_width(text_width);
                ui.spacing_mut().item_spacing.y = 0.0;
                // The first line of the text is centred on the icon.
                let line = ui.text_style_height(&egui::TextStyle::Body);
                ui.add_space((24.0 - line) / 2.0);
                // The text is selectable, so that users can copy an error into a bug report.
                ui.add(Label::new(&notice.text).wrap().selectable(true));
                if let Some(file) = &notice.file {
                    ui.add_space(GRID);
                    file_buttons(ui, file);
                }
                if exceeds_limits {
                    ui.add_space(GRID);
                    let tip = "Builds it no matter how long it takes. You can cancel at any time.";
                    if ui.button("Build anyway").on_hover_text(tip).clicked() {
                        intents.push(Intent::BuildAnyway);
                    }
                }
            });
            let close = icon_button(ui, icons::CLOSE, "Close", vec2(24.0, 24.0));
            if close.clicked() {
                intents.push(Intent::DismissNotice(notice.id));
            }
        });
    });
}

/// Draws the buttons that show the folder of an exported file and that copy its path.
fn file_buttons(ui: &mut Ui, file: &Path) {
    ui.horizontal(|ui| {
        let folder = if file.is_dir() {
            Some(file)
        } else {
            file.parent()
        };
        let tip = "Opens the folder that contains the file.";
        if ui.button("Show folder").on_hover_text(tip).clicked()
            && let Some(folder) = folder
        {
            // If there is no file manager, nothing happens. The notice shows the path in any case.
            open::that_detached(folder).ok();
        }
        let tip = "Copies the path to the clipboard.";
        if ui.button("Copy path").on_hover_text(tip).clicked() {
            ui.copy_text(file.display().to_string());
        }
    });
}
