//! The questions that the program asks: about what would be lost, and what a dropped file is for.

use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, ScrollArea, Ui, vec2};

use crate::app::asking::intent::{Answer, Intent, Rescue};
use crate::app::opening::closing::Lost;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID};
use crate::app::ui::kit::widgets::{option, primary_button};
use crate::app::ui::scene::{Intents, Scene};

/// Draws the question that is open, if any.
pub fn show(ctx: &Context, scene: &Scene, acts: &mut Intents) {
    if let (Some(words), Some(lost)) = (scene.question.text(), scene.question.lost()) {
        ask_first(ctx, lost, words, acts);
    } else if let Some((title, age)) = scene.autosave.lost() {
        ask_lost(ctx, title, age, acts);
    } else if let Some(path) = scene.drop.undecided() {
        ask_drop(ctx, path, acts);
    } else if !scene.drop.many().is_empty() {
        ask_which(ctx, scene.drop.many(), acts);
    }
}

/// The heading, and how to keep or give up what would be lost.
fn words(lost: Lost) -> [&'static str; 3] {
    match lost {
        Lost::Changes => ["Unsaved changes", "Save", "Do not save"],
        Lost::Film => ["A film is being written", "Wait for it", "Stop it"],
    }
}

fn ask_first(ctx: &Context, lost: Lost, question: &str, acts: &mut Intents) {
    let [heading, keep, give_up] = words(lost);
    Modal::new(Id::new("what would be lost")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(heading);
        ui.add(Label::new(question).wrap());
        answers(ui, |ui| {
            if primary_button(ui, keep).clicked() {
                acts.push(Intent::Answer(Answer::Save));
            }
            let mut answer = |ui: &mut Ui, text: &str, answer: Answer| {
                if ui.button(text).clicked() {
                    acts.push(Intent::Answer(answer));
                }
            };
            answer(ui, give_up, Answer::Discard);
            answer(ui, "Cancel", Answer::Stay);
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
                acts.push(Intent::Rescue(Rescue::Restore));
            }
            let mut answer = |ui: &mut Ui, text: &str, tip: &str, answer: Rescue| {
                if ui.button(text).on_hover_text(tip).clicked() {
                    acts.push(Intent::Rescue(answer));
                }
            };
            let tip = "Throws the changes away.";
            answer(ui, "Discard", tip, Rescue::Discard);
            let tip = "Asks again at the next start (Esc).";
            answer(ui, "Later", tip, Rescue::Later);
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

fn ask_drop(ctx: &Context, path: &Path, acts: &mut Intents) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Modal::new(Id::new("drop")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading("One design");
        let words = format!("What is {name} for? Drop two files to open a new pair.");
        ui.add(Label::new(words).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Use as target").clicked() {
                acts.push(Intent::ReplaceDesign(1, path.to_owned()));
            }
            if primary_button(ui, "Use as source").clicked() {
                acts.push(Intent::ReplaceDesign(0, path.to_owned()));
            }
            if ui.button("Cancel").clicked() {
                acts.push(Intent::Back);
            }
        });
    });
}

/// Which two of many designs are a pair.
fn ask_which(ctx: &Context, paths: &[PathBuf], acts: &mut Intents) {
    let id = Id::new("which two");
    // The first two, until somebody says otherwise.
    let mut pair: [usize; 2] = ctx.data(|data| data.get_temp(id)).unwrap_or([0, 1]);
    pair = pair.map(|k| k.min(paths.len() - 1));
    Modal::new(id).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(format!("{} designs", paths.len()));
        ui.label("A film has two: which?");
        ui.add_space(GRID);
        ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
            for (k, path) in paths.iter().enumerate() {
                row(ui, k, path, &mut pair);
            }
        });
        answers(ui, |ui| {
            let can = pair[0] != pair[1];
            let open = ui.add_enabled_ui(can, |ui| primary_button(ui, "Open the pair"));
            if open.inner.clicked() {
                let pair = pair.map(|k| paths[k].clone());
                acts.push(Intent::Open(pair.into()));
            }
            if ui.button("Cancel").clicked() {
                acts.push(Intent::Back);
            }
        });
    });
    ctx.data_mut(|data| data.insert_temp(id, pair));
}

/// A design that may be one of the pair; taken for both ends it changes places with the other.
fn row(ui: &mut Ui, k: usize, path: &Path, pair: &mut [usize; 2]) {
    ui.horizontal(|ui| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let size = vec2(236.0, CONTROL_HEIGHT);
        let left = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(size, left, |ui| {
            ui.set_min_width(size.x);
            ui.add(Label::new(name).truncate());
        });
        for (end, word, tip) in [
            (0, "Source", "The film begins with it"),
            (1, "Target", "The film ends with it"),
        ] {
            if option(ui, pair[end] == k, word, tip, 68.0) && pair[end] != k {
                if pair[1 - end] == k {
                    pair[1 - end] = pair[end];
                }
                pair[end] = k;
            }
        }
    });
}

fn answers(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.add_space(GRID);
    ui.with_layout(Layout::right_to_left(Align::Center), buttons);
}
