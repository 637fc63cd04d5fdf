//! The dialog that asks for files.

use std::path::Path;

use bevy::prelude::Resource;
use bevy_egui::egui::{Align2, Context, Key, Ui, Vec2, vec2};
use egui_file_dialog::{DialogState, DirectoryEntry, FileDialog, OpeningMode};

use crate::app::files::file_dialog::DialogPurpose;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme;
use crate::app::ui::overlays::file_side_panel;
use crate::app::ui::overlays::file_side_panel::TypedPath;
use crate::app::ui::ui_state::{Intents, UiState};

/// It fits into the smallest window.
const SIZE: Vec2 = vec2(760.0, 440.0);

/// The dialog that is drawn, and what for.
#[derive(Resource, Default)]
pub struct FileDialogState(Option<OpenFileDialog>);

struct OpenFileDialog {
    asks: DialogPurpose,
    dialog: FileDialog,
    typed: TypedPath,
}

/// Draws the dialog while files are asked for.
pub fn show(ctx: &Context, scene: &UiState, files: &mut FileDialogState, acts: &mut Intents) {
    let Some(asks) = scene.dialog.asks() else {
        files.0 = None;
        return;
    };
    files.0.take_if(|shown| shown.asks != *asks);
    let shown = files.0.get_or_insert_with(|| OpenFileDialog {
        asks: asks.clone(),
        dialog: dialog(asks, scene),
        typed: TypedPath::default(),
    });
    // At once: the dialog itself lets go of its text field first.
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        acts.push(Intent::Choose(Vec::new()));
        return;
    }
    // It writes what is chosen in the colour of the mark behind it.
    theme::with_bright_selection(ctx, |ctx| match asks {
        DialogPurpose::Save(_) => {
            shown.dialog.update(ctx);
        }
        _ => reading(ctx, scene, shown, acts),
    });
    match shown.dialog.state() {
        DialogState::Open => {}
        DialogState::Picked(path) => acts.push(Intent::Choose(vec![path.clone()])),
        DialogState::PickedMultiple(paths) => acts.push(Intent::Choose(paths.clone())),
        DialogState::Cancelled | DialogState::Closed => acts.push(Intent::Choose(Vec::new())),
    }
}

/// With what is beside the list of files that can be read.
fn reading(ctx: &Context, scene: &UiState, shown: &mut OpenFileDialog, acts: &mut Intents) {
    let filters = shown.asks.filters();
    let extensions = filters.first().map_or(&[][..], |(_, ends)| ends);
    let typed = &mut shown.typed;
    let mut panel = |ui: &mut Ui, dialog: &mut FileDialog| {
        let marked = dialog.selected_entries().last();
        let entry = marked.or(dialog.selected_entry());
        let folder = match entry {
            Some(entry) if entry.is_dir() => Some(entry.as_path()),
            Some(entry) => entry.as_path().parent(),
            None => scene.dialog.folder(),
        };
        let folder = folder.unwrap_or(Path::new("."));
        if let Some(path) = file_side_panel::field(ui, typed, folder, extensions) {
            acts.push(Intent::Choose(vec![path]));
        }
        let file = entry.filter(|entry| entry.is_file() && !typed.has_offers());
        file_side_panel::preview(ui, scene, file.map(DirectoryEntry::as_path), acts);
    };
    shown.dialog.update_with_right_panel_ui(ctx, &mut panel);
}

fn dialog(asks: &DialogPurpose, scene: &UiState) -> FileDialog {
    let mut dialog = FileDialog::new()
        .title(asks.title())
        .opening_mode(OpeningMode::AlwaysInitialDir)
        .default_size(SIZE)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .resizable(false)
        // Its field is black on either theme; the typed path completes, which finds as well.
        .show_search(false)
        // A link is named as it was chosen.
        .canonicalize_paths(false);
    dialog.set_right_panel_width(file_side_panel::WIDTH);
    let recent = scene.recent.folders();
    // Where files were chosen last, or opened.
    if let Some(folder) = scene.dialog.folder().or(recent.first().copied()) {
        dialog = dialog.initial_directory(folder.to_owned());
    }
    if !recent.is_empty() {
        dialog = dialog.add_quick_access("Recent", |links| {
            for folder in recent {
                let name = folder.file_name().unwrap_or(folder.as_os_str());
                links.add_path(&name.to_string_lossy(), folder);
            }
        });
    }
    for (index, (name, extensions)) in asks.filters().into_iter().enumerate() {
        dialog = dialog.add_file_filter_extensions(&name, extensions);
        if index == 0 {
            dialog = dialog.default_file_filter(&name);
        }
    }
    match asks {
        DialogPurpose::Open | DialogPurpose::Insert(_) => dialog.pick_multiple(),
        DialogPurpose::Replace(_) => dialog.pick_file(),
        DialogPurpose::Save(name) => {
            dialog = dialog.default_file_name(name);
            dialog.save_file();
        }
    }
    dialog
}
