//! Modal questions to the user: whether to save unsaved changes or stop an export, whether to
//! recover unsaved work, and where a single opened or dropped design goes.

use std::path::Path;
use std::time::Duration;

use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, Rect, Ui};

use crate::app::input::intent::{Intent, RecoveryAnswer, UnsavedAnswer};
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::primary_button;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::unsaved_question::UnsavedKind;
use crate::design::DesignSource;
use crate::project::Project;

/// Draws the question that waits for an answer, if there is one; returns its rectangle.
pub fn show(ctx: &Context, state: &UiState, intents: &mut Intents) -> Option<Rect> {
    let question = if let (Some(words), Some(kind)) = (state.question.text(), state.question.kind())
    {
        ask_before_closing(ctx, kind, words, intents)
    } else if let Some((title, age)) = state.autosave.recoverable() {
        ask_recover(ctx, title, age, intents)
    } else if let Some(path) = state.dropped_design.undecided() {
        ask_drop(ctx, state, path, intents)
    } else {
        return None;
    };
    Some(question)
}

/// Draws a question as a dialog of the given width above everything else; returns its rectangle.
fn dialog(ctx: &Context, name: &str, width: f32, content: impl FnOnce(&mut Ui)) -> Rect {
    let shown = Modal::new(Id::new(name)).show(ctx, |ui| {
        ui.set_width(width);
        content(ui);
    });
    shown.response.rect
}

/// Returns the heading of the question, the label of the button that keeps the work, and the label
/// of the button that discards it.
fn labels(kind: UnsavedKind) -> [&'static str; 3] {
    match kind {
        UnsavedKind::Changes => ["Unsaved changes", "Save", "Don't save"],
        UnsavedKind::Film => ["Export in progress", "Wait", "Stop export"],
    }
}

fn ask_before_closing(
    ctx: &Context,
    kind: UnsavedKind,
    question: &str,
    intents: &mut Intents,
) -> Rect {
    let [heading, keep, discard] = labels(kind);
    dialog(ctx, "unsaved changes", 400.0, |ui| {
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
    })
}

/// Asks whether to recover unsaved work after the program ended unexpectedly. `age` is the time
/// since the work was stored.
fn ask_recover(ctx: &Context, title: &str, age: Option<Duration>, intents: &mut Intents) -> Rect {
    dialog(ctx, "recover", 400.0, |ui| {
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
    })
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

/// Asks where a single design goes: into a new film with a second design, or into the open project.
fn ask_drop(ctx: &Context, state: &UiState, path: &Path, intents: &mut Intents) -> Rect {
    let name = DesignSource::from_path(path).name();
    // A project that plays next to the invitation was not opened by the user, so nothing is added
    // to it.
    let project = state
        .session
        .whole_project()
        .filter(|_| !state.invitation.is_shown());
    dialog(ctx, "drop", 520.0, |ui| {
        ui.heading("One design chosen");
        let open_film = match project {
            Some(_) => ", or use it in the open film",
            None => "",
        };
        let text = format!(
            "A film leads from one design to another. Choose the second design for a new film \
             that starts with “{name}”{open_film}."
        );
        ui.add(Label::new(text).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Choose second …").clicked() {
                intents.push(Intent::AskSecond(path.to_owned()));
            }
            match project {
                Some(project) => use_in_film(ui, state, project, path, intents),
                None => {
                    if ui.button("Show it alone").clicked() {
                        intents.push(Intent::OpenAlone(path.to_owned()));
                    }
                }
            }
            if ui.button("Cancel").clicked() {
                intents.push(Intent::Escape);
            }
        });
    })
}

/// Draws the buttons that add a design to the open project or replace a design of its current
/// segment, from right to left.
fn use_in_film(
    ui: &mut Ui,
    state: &UiState,
    project: &Project,
    path: &Path,
    intents: &mut Intents,
) {
    if ui.button("Add at end").clicked() {
        let end = project.designs.len();
        intents.push(Intent::InsertDesigns(end, vec![path.to_owned()]));
    }
    let [source, target] = project.segment_designs(state.session.segment());
    for (text, index) in [("Replace target", target), ("Replace source", source)] {
        if ui.button(text).clicked() {
            intents.push(Intent::ReplaceDesign(index, path.to_owned()));
        }
    }
}

fn answers(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.add_space(GRID);
    ui.with_layout(Layout::right_to_left(Align::Center), buttons);
}
