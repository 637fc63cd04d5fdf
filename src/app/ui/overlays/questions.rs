//! The questions that the program asks: about what would be lost, and what a dropped file is for.

use std::path::Path;
use std::time::Duration;

use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, Ui};

use crate::app::input::intent::{Intent, RecoveryAnswer, UnsavedAnswer};
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::primary_button;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::unsaved_question::UnsavedKind;

/// Draws the question that is open, if any.
pub fn show(ctx: &Context, scene: &UiState, acts: &mut Intents) {
    if let (Some(words), Some(lost)) = (scene.question.text(), scene.question.lost()) {
        ask_first(ctx, lost, words, acts);
    } else if let Some((title, age)) = scene.autosave.lost() {
        ask_lost(ctx, title, age, acts);
    } else if let Some(path) = scene.drop.undecided() {
        ask_drop(ctx, scene, path, acts);
    }
}

/// The heading, and how to keep or give up what would be lost.
fn words(lost: UnsavedKind) -> [&'static str; 3] {
    match lost {
        UnsavedKind::Changes => ["Unsaved changes", "Save", "Do not save"],
        UnsavedKind::Film => ["A film is being written", "Wait for it", "Stop it"],
    }
}

fn ask_first(ctx: &Context, lost: UnsavedKind, question: &str, acts: &mut Intents) {
    let [heading, keep, give_up] = words(lost);
    Modal::new(Id::new("what would be lost")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(heading);
        ui.add(Label::new(question).wrap());
        answers(ui, |ui| {
            if primary_button(ui, keep).clicked() {
                acts.push(Intent::Answer(UnsavedAnswer::Save));
            }
            let mut answer = |ui: &mut Ui, text: &str, answer: UnsavedAnswer| {
                if ui.button(text).clicked() {
                    acts.push(Intent::Answer(answer));
                }
            };
            answer(ui, give_up, UnsavedAnswer::Discard);
            answer(ui, "Cancel", UnsavedAnswer::Stay);
        });
    });
}

/// What was not saved when the program ended.
fn ask_lost(ctx: &Context, title: &str, age: Option<Duration>, acts: &mut Intents) {
    Modal::new(Id::new("what was lost")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading("Not saved last time");
        let when = age.map_or_else(String::new, |age| format!(", {}", ago(age)));
        let words = format!(
            "Morphospace ended while “{title}” had changes that were not saved{when}. They were \
             kept."
        );
        ui.add(Label::new(words).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Restore").clicked() {
                acts.push(Intent::Rescue(RecoveryAnswer::Restore));
            }
            let mut answer = |ui: &mut Ui, text: &str, tip: &str, answer: RecoveryAnswer| {
                if ui.button(text).on_hover_text(tip).clicked() {
                    acts.push(Intent::Rescue(answer));
                }
            };
            let tip = "Throws the changes away.";
            answer(ui, "Discard", tip, RecoveryAnswer::Discard);
            let tip = "Asks again at the next start (Esc).";
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

fn ask_drop(ctx: &Context, scene: &UiState, path: &Path, acts: &mut Intents) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(whole) = scene.session.whole() else {
        return;
    };
    // Of the two that are looked at.
    let [source, target] = whole.leg_designs(scene.session.leg());
    Modal::new(Id::new("drop")).show(ctx, |ui| {
        ui.set_width(440.0);
        ui.heading("One design");
        let words = format!(
            "What is {name} for? It can come after the others, as a further design of the film, or \
             take the place of one. Drop two files or more to open a new project."
        );
        ui.add(Label::new(words).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Add at the end").clicked() {
                let end = whole.designs.len();
                acts.push(Intent::InsertDesigns(end, vec![path.to_owned()]));
            }
            let mut replace = |ui: &mut Ui, words: &str, index: usize| {
                if ui.button(words).clicked() {
                    acts.push(Intent::ReplaceDesign(index, path.to_owned()));
                }
            };
            replace(ui, "Use as target", target);
            replace(ui, "Use as source", source);
            if ui.button("Cancel").clicked() {
                acts.push(Intent::Back);
            }
        });
    });
}

fn answers(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.add_space(GRID);
    ui.with_layout(Layout::right_to_left(Align::Center), buttons);
}
