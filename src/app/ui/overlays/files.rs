//! The dialog that asks for files.

use bevy::prelude::Resource;
use bevy_egui::egui::{Align2, Context, Key, Vec2, vec2};
use egui_file_dialog::{DialogState, FileDialog, OpeningMode};

use crate::app::asking::intent::Intent;
use crate::app::opening::dialogs::{Dialog, Purpose};
use crate::app::ui::scene::{Intents, Scene};

/// It fits into the smallest window.
const SIZE: Vec2 = vec2(760.0, 440.0);

/// The dialog that is drawn, and what for.
#[derive(Resource, Default)]
pub struct Files(Option<(Purpose, FileDialog)>);

/// Draws the dialog while files are asked for.
pub fn show(ctx: &Context, scene: &Scene, files: &mut Files, acts: &mut Intents) {
    let Some(asks) = scene.dialog.asks() else {
        files.0 = None;
        return;
    };
    files.0.take_if(|(shown, _)| shown != asks);
    let new = || (asks.clone(), dialog(asks, &scene.dialog));
    let (_, shown) = files.0.get_or_insert_with(new);
    // At once: the dialog itself lets go of its text field first.
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        acts.push(Intent::Choose(Vec::new()));
        return;
    }
    match shown.update(ctx).state() {
        DialogState::Open => {}
        DialogState::Picked(path) => acts.push(Intent::Choose(vec![path.clone()])),
        DialogState::PickedMultiple(paths) => acts.push(Intent::Choose(paths.clone())),
        DialogState::Cancelled | DialogState::Closed => acts.push(Intent::Choose(Vec::new())),
    }
}

fn dialog(asks: &Purpose, from: &Dialog) -> FileDialog {
    let mut dialog = FileDialog::new()
        .title(asks.title())
        .opening_mode(OpeningMode::AlwaysInitialDir)
        .default_size(SIZE)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .resizable(false)
        // A link is named as it was chosen.
        .canonicalize_paths(false);
    if let Some(folder) = from.folder() {
        dialog = dialog.initial_directory(folder.to_owned());
    }
    for (index, (name, extensions)) in asks.filters().into_iter().enumerate() {
        dialog = dialog.add_file_filter_extensions(&name, extensions);
        if index == 0 {
            dialog = dialog.default_file_filter(&name);
        }
    }
    match asks {
        Purpose::Open => dialog.pick_multiple(),
        Purpose::Replace(_) => dialog.pick_file(),
        Purpose::Save(name) => {
            dialog = dialog.default_file_name(name);
            dialog.save_file();
        }
    }
    dialog
}
