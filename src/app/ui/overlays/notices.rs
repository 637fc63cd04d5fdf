//! Messages at the lower edge of the stage; problems stay until they are closed.

use std::path::Path;

use bevy_egui::egui::{self, Align2, Context, Label, Order, Rect, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::notices::{Notice, NoticeKind, NoticeTopic};
use crate::app::session::load::TransitionProblem;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{card, fixed_layer, icon_button};
use crate::app::ui::ui_state::{Intents, UiState};

/// The most that are shown at once; older ones wait until a newer one is closed.
const MOST: usize = 4;

/// Draws the messages.
pub fn show(ctx: &Context, scene: &UiState, stage: Rect, acts: &mut Intents) {
    let list = scene.notices.list();
    if list.is_empty() {
        return;
    }
    let width = (stage.width() - 4.0 * GRID).clamp(160.0, 480.0);
    let at = stage.center_bottom() - vec2(0.0, 2.0 * GRID);
    // Above the verdict and the work: a problem is read first.
    let area = fixed_layer("notices", Align2::CENTER_BOTTOM, at).order(Order::Foreground);
    area.show(ctx, |ui| {
        for notice in &list[list.len().saturating_sub(MOST)..] {
            let too_much = is_too_much(scene, notice);
            message(ui, notice, too_much, width, acts);
        }
    });
}

/// The problem is but that it takes long.
fn is_too_much(scene: &UiState, notice: &Notice) -> bool {
    let problem = scene.session.problem();
    notice.kind == NoticeKind::Problem(NoticeTopic::Transition)
        && problem.is_some_and(TransitionProblem::is_too_much)
}

fn message(ui: &mut Ui, notice: &Notice, too_much: bool, width: f32, acts: &mut Intents) {
    let palette = ThemePalette::of(ui);
    let (icon, colour) = match notice.kind {
        NoticeKind::Problem(_) => (icons::WARNING, palette.problem),
        NoticeKind::Done | NoticeKind::Wrote => (icons::TICK, palette.accent),
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
                // A line in the middle of the icons' square; more lines go on below it.
                let line = ui.text_style_height(&egui::TextStyle::Body);
                ui.add_space((24.0 - line) / 2.0);
                // So that an error can be copied into a report.
                ui.add(Label::new(&notice.text).wrap().selectable(true));
                if let Some(file) = &notice.file {
                    ui.add_space(GRID);
                    go_to(ui, file);
                }
                if too_much {
                    ui.add_space(GRID);
                    let tip = "Builds it however long it takes; it can be cancelled.";
                    if ui
                        .button("Build it all the same")
                        .on_hover_text(tip)
                        .clicked()
                    {
                        acts.push(Intent::Insist);
                    }
                }
            });
            let close = icon_button(ui, icons::CLOSE, "Close", vec2(24.0, 24.0));
            if close.clicked() {
                acts.push(Intent::Dismiss(notice.id));
            }
        });
    });
}

/// Ways to a file that was written.
fn go_to(ui: &mut Ui, file: &Path) {
    ui.horizontal(|ui| {
        let folder = if file.is_dir() {
            Some(file)
        } else {
            file.parent()
        };
        let tip = "Opens the folder that it lies in.";
        if ui.button("Show folder").on_hover_text(tip).clicked()
            && let Some(folder) = folder
        {
            // Where the system has nothing to show folders with, the path still says where it is.
            open::that_detached(folder).ok();
        }
        let tip = "Puts the path where Ctrl V takes it from.";
        if ui.button("Copy path").on_hover_text(tip).clicked() {
            ui.copy_text(file.display().to_string());
        }
    });
}
