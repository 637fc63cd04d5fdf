//! The two questions that the program asks: about unsaved changes, and what a dropped file is for.

use std::path::Path;

use bevy_egui::egui::{Align, Context, Id, Label, Layout, Modal, Ui};

use crate::app::asking::intent::{Answer, Intent};
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::primary_button;
use crate::app::ui::scene::{Intents, Scene};

/// Draws the question that is open, if any.
pub fn show(ctx: &Context, scene: &Scene, acts: &mut Intents) {
    if let Some(question) = scene.question.text() {
        ask_unsaved(ctx, question, acts);
    } else if let Some(path) = scene.drop.undecided() {
        ask_drop(ctx, path, acts);
    }
}

fn ask_unsaved(ctx: &Context, question: &str, acts: &mut Intents) {
    Modal::new(Id::new("unsaved")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading("Unsaved changes");
        ui.add(Label::new(question).wrap());
        answers(ui, |ui| {
            if primary_button(ui, "Save").clicked() {
                acts.push(Intent::Answer(Answer::Save));
            }
            let mut answer = |ui: &mut Ui, text: &str, answer: Answer| {
                if ui.button(text).clicked() {
                    acts.push(Intent::Answer(answer));
                }
            };
            answer(ui, "Do not save", Answer::Discard);
            answer(ui, "Cancel", Answer::Stay);
        });
    });
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

fn answers(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.add_space(GRID);
    ui.with_layout(Layout::right_to_left(Align::Center), buttons);
}
