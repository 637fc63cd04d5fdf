//! Modal questions to the user: whether to save unsaved changes or stop an export, whether to
//! recover unsaved work, whether to replace a project file that was changed elsewhere, and where a
//! single opened or dropped design goes.

use std::path::Path;
use std::time::Duration;

use bevy_egui::egui::text::LayoutJob;
use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, Rect, Response, TextStyle, Ui};

use crate::app::input::intent::{ConflictAnswer, Intent, RecoveryAnswer, UnsavedAnswer};
use crate::app::ui::kit::text::shortened;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::primary_button;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::unsaved_question::UnsavedKind;
use crate::design::DesignSource;
use crate::io::sanitize::SanitizedLine;
use crate::project::Project;

/// Maximum number of rows of a question's text (layout limit: with its heading and buttons, the
/// question must fit into the smallest window; a shortened text in usual scripts takes fewer rows).
const MAX_ROWS: usize = 12;

/// Draws the question that waits for an answer, if there is one; returns its rectangle.
pub fn show(ctx: &Context, state: &UiState, intents: &mut Intents) -> Option<Rect> {
    let question = if state.conflict.is_open() {
        ask_conflict(ctx, &state.session.title(), intents)
    } else if let (Some(words), Some(kind)) = (state.question.text(), state.question.kind()) {
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

/// Draws the text of a question. Its names come from files and may be of any length and script, so
/// it is shortened; the whole text appears on hover.
fn question_text(ui: &mut Ui, text: &str) {
    let whole = SanitizedLine(text).to_string();
    let short = shortened(&whole);
    let font = TextStyle::Body.resolve(ui.style());
    let colour = ui.visuals().text_color();
    let mut job = LayoutJob::simple(short.clone(), font, colour, ui.available_width());
    job.wrap.max_rows = MAX_ROWS;
    let label = ui.add(Label::new(job).wrap());
    if short != whole {
        label.on_hover_text(whole);
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

fn ask_before_closing(
    ctx: &Context,
    kind: UnsavedKind,
    question: &str,
    intents: &mut Intents,
) -> Rect {
    let [heading, keep, discard] = labels(kind);
    dialog(ctx, "unsaved changes", 400.0, |ui| {
        ui.heading(heading);
        question_text(ui, question);
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

/// Asks whether to replace a project file that was changed elsewhere.
fn ask_conflict(ctx: &Context, title: &str, intents: &mut Intents) -> Rect {
    dialog(ctx, "conflict", 440.0, |ui| {
        ui.heading("The file has changed on disk");
        let text =
            format!("The file of “{title}” has changed since it was opened or last saved here.");
        question_text(ui, &text);
        answers(ui, |ui| {
            let mut answer = |button: Response, tip: &str, answer: ConflictAnswer| {
                if button.on_hover_text(tip).clicked() {
                    intents.push(Intent::AnswerConflict(answer));
                }
            };
            let tip = "Saves your version as another file.";
            answer(primary_button(ui, "Save as …"), tip, ConflictAnswer::SaveAs);
            let tip = "Replaces the file with your version.";
            answer(ui.button("Overwrite"), tip, ConflictAnswer::Overwrite);
            let tip = "Discards your changes and keeps the file.";
            answer(ui.button("Reload file"), tip, ConflictAnswer::Reload);
            let tip = "Leaves the file unchanged (Esc).";
            answer(ui.button("Cancel"), tip, ConflictAnswer::Cancel);
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
        question_text(ui, &text);
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
        question_text(ui, &text);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::ui::kit::text::MAX_CHARS;
    use bevy_egui::egui::{Pos2, RawInput, vec2};

    /// Rectangle of a dialog in a small window.
    fn drawn(window: Rect, draw: impl Fn(&Context) -> Rect) -> Rect {
        let ctx = Context::default();
        let input = RawInput {
            screen_rect: Some(window),
            ..RawInput::default()
        };
        let mut rect = Rect::NOTHING;
        // The size of the dialog is known from the second pass on.
        for _ in 0..3 {
            let output = ctx.run_ui(input.clone(), |ui| rect = draw(ui.ctx()));
            output.drop_without_applying_deltas();
        }
        rect
    }

    #[test]
    fn buttons_stay_in_the_window_for_any_title() {
        let window = Rect::from_min_size(Pos2::ZERO, vec2(800.0, 600.0));
        for title in [
            "x".repeat(10_000),
            "word ".repeat(2_000),
            "字".repeat(10_000),
            "\u{fdfd}".repeat(10_000),
            "a\n".repeat(5_000),
            "/folder".repeat(1_500),
        ] {
            let text = format!("“{title}” has unsaved changes.");
            let dialogs: [&dyn Fn(&Context) -> Rect; 3] = [
                &|ctx| ask_before_closing(ctx, UnsavedKind::Changes, &text, &mut Vec::new()),
                &|ctx| ask_recover(ctx, &title, Some(Duration::ZERO), &mut Vec::new()),
                &|ctx| ask_conflict(ctx, &title, &mut Vec::new()),
            ];
            for dialog in dialogs {
                let rect = drawn(window, dialog);
                assert!(rect.is_positive() && window.contains_rect(rect), "{rect:?}");
            }
        }
    }

    #[test]
    fn a_shortened_question_keeps_its_start_and_end() {
        let text = format!("“{}” has unsaved changes.", "字".repeat(10_000));
        let short = shortened(&SanitizedLine(text).to_string());
        assert!(short.starts_with("“字") && short.ends_with("字” has unsaved changes."));
        assert_eq!(short.chars().count(), MAX_CHARS);
    }
}
