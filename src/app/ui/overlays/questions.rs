//! Modal questions to the user: whether to save unsaved changes or stop an export, whether to
//! recover unsaved work, and whether a dropped design is added to the film or replaces a design.

use std::path::Path;
use std::time::Duration;

use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, Ui};

use crate::app::input::intent::{Intent, RecoveryAnswer, UnsavedAnswer};
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::primary_button;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::unsaved_question::UnsavedKind;

/// Draws the question that waits for an answer, if there is one.
pub fn show(ctx: &Context, state: &UiState, intents: &mut Intents) {
    if let (Some(words), Some(kind)) = (state.question.text(), state.question.kind()) {
        ask_before_closing(ctx, kind, words, intents);
    } else if let Some((title, age)) = state.autosave.recoverable() {
        ask_recover(ctx, title, age, intents);
    } else if let Some(path) = state.dropped_design.undecided() {
        ask_drop(ctx, state, path, intents);
    }
}

/// Returns the heading of the question, the label of the button that keeps the work, and the label
/// of the button that discards it.
fn labels(kind: UnsavedKind) -> [&'static str; 3] {
    match kind {
        UnsavedKind::Changes => ["Unsaved changes", "Save", "Don't save"],
        UnsavedKind::Film => ["Export in progress", "Wait", "Stop export"],
    }
}

fn ask_before_closing(ctx: &Context, kind: UnsavedKind, question: &str, intents: &mut Intents) {
    let [heading, keep, discard] = labels(kind);
    Modal::new(Id::new("unsaved changes")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(heading);
        ui.add(Label::new(question).wrap());
        answers(ui, |ui| {
            if primary_button(ui, keep).clicked() {
                intents.push(Intent::AnswerUnsaved(UnsavedAnswer::Save));
            }
            let mut answer = |ui: &mut Ui, text: &str, answer: UnsavedAnswer| {
                if ui.button(text).clicked() {
                    intents.push(Intent::AnswerUnsaved(answer));
                }
            };
            answer(ui, discard, UnsavedAnswer::Discard);
            answer(ui, "Cancel", UnsavedAnswer::Cancel);
        });
    });
}

/// Asks whether to recover unsaved work after the program ended unexpectedly. `age` is the time
/// since the work was stored.
fn ask_recover(ctx: &Context, title: &str, age: Option<Duration>, intents: &mut Intents) {
    Modal::new(Id::new("recover")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading("Recover unsaved work?");
        let when = age.map_or_else(String::new, |age| format!(", {}", ago(age)));
        let text = format!(
            "Morphospace closed before changes to “{title}” were saved{when}. They can be \
             recovered."
        );
        ui.add(Label::new(text).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Recover").clicked() {
                intents.push(Intent::AnswerRecovery(RecoveryAnswer::Restore));
            }
            let mut answer = |ui: &mut Ui, text: &str, tip: &str, answer: RecoveryAnswer| {
                if ui.button(text).on_hover_text(tip).clicked() {
                    intents.push(Intent::AnswerRecovery(answer));
                }
            };
            let tip = "Deletes the unsaved changes.";
            answer(ui, "Discard", tip, RecoveryAnswer::Discard);
            let tip = "Asks again the next time Morphospace starts (Esc).";
            answer(ui, "Later", tip, RecoveryAnswer::Later);
        });
    });
}

fn ago(age: Duration) -> String {
    let minutes = age.as_secs() / 60;
    match minutes {
        0 => "less than a minute ago".to_owned(),
        1 => "a minute ago".to_owned(),
        2..=119 => format!("{minutes} minutes ago"),
        _ => match minutes / 60 {
            hours @ ..=47 => format!("{hours} hours ago"),
            hours => format!("{} days ago", hours / 24),
        },
    }
}

fn ask_drop(ctx: &Context, state: &UiState, path: &Path, intents: &mut Intents) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(project) = state.session.whole_project() else {
        return;
    };
    // The dropped file can replace one of the two designs of the current segment.
    let [source, target] = project.segment_designs(state.session.segment());
    Modal::new(Id::new("drop")).show(ctx, |ui| {
        ui.set_width(440.0);
        ui.heading("Add or replace a design");
        let text = format!(
            "Where should {name} go? Add it as the last design of the film, or replace the target \
             or the source. To open a new project instead, drop two or more files."
        );
        ui.add(Label::new(text).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Add at end").clicked() {
                let end = project.designs.len();
                intents.push(Intent::InsertDesigns(end, vec![path.to_owned()]));
            }
            let mut replace = |ui: &mut Ui, text: &str, index: usize| {
                if ui.button(text).clicked() {
                    intents.push(Intent::ReplaceDesign(index, path.to_owned()));
                }
            };
            replace(ui, "Replace target", target);
            replace(ui, "Replace source", source);
            if ui.button("Cancel").clicked() {
                intents.push(Intent::Escape);
            }
        });
    });
}

fn answers(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.add_space(GRID);
    ui.with_layout(Layout::right_to_left(Align::Center), buttons);
}
