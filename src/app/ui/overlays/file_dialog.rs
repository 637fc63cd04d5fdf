//! File dialog for opening, inserting, replacing and saving files.

use std::path::Path;

use bevy::prelude::Resource;
use bevy_egui::egui::{Align2, Context, Key, Rect, Ui, Vec2, vec2};
use egui_file_dialog::{DialogState, DirectoryEntry, FileDialog, OpeningMode};

use crate::app::files::file_dialog::DialogPurpose;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme;
use crate::app::ui::overlays::file_side_panel;
use crate::app::ui::overlays::file_side_panel::{TextDesign, TypedPath};
use crate::app::ui::ui_state::{Intents, UiState};

/// Size of the file dialog, in points. It must fit into the smallest window.
const SIZE: Vec2 = vec2(760.0, 440.0);

/// The file dialog, while it is open.
#[derive(Resource, Default)]
pub struct FileDialogState(Option<OpenFileDialog>);

struct OpenFileDialog {
    purpose: DialogPurpose,
    dialog: FileDialog,
    typed: TypedPath,
    text: TextDesign,
}

/// Draws the file dialog while the app requests files, and sends the user's answer. Returns the
/// rectangle of the dialog, if it is open.
pub fn show(
    ctx: &Context,
    state: &UiState,
    files: &mut FileDialogState,
    intents: &mut Intents,
) -> Option<Rect> {
    let Some(purpose) = state.dialog.purpose() else {
        files.0 = None;
        return None;
    };
    files
        .0
        .take_if(|open_dialog| open_dialog.purpose != *purpose);
    let open_dialog = files.0.get_or_insert_with(|| OpenFileDialog {
        purpose: purpose.clone(),
        dialog: dialog(purpose, state),
        typed: TypedPath::default(),
        text: TextDesign::default(),
    });
    // Escape is handled here, because the dialog itself would first remove the focus from its text
    // field instead of closing.
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        intents.push(Intent::AnswerDialog(Vec::new()));
        return None;
    }
    // The dialog uses the background colour of selected text as the text colour of selected names,
    // so this colour must be bright.
    theme::with_bright_selection(ctx, |ctx| match purpose {
        DialogPurpose::Save(_) | DialogPurpose::Export(..) => {
            open_dialog.dialog.update(ctx);
        }
        _ => draw_with_side_panel(ctx, state, open_dialog, intents),
    });
    match open_dialog.dialog.state() {
        DialogState::Open => {}
        DialogState::Picked(path) => intents.push(Intent::AnswerDialog(vec![path.clone()])),
        DialogState::PickedMultiple(paths) => intents.push(Intent::AnswerDialog(paths.clone())),
        DialogState::Cancelled | DialogState::Closed => {
            intents.push(Intent::AnswerDialog(Vec::new()))
        }
    }
    let window = open_dialog.dialog.get_window_id();
    ctx.memory(|memory| memory.area_rect(window))
}

/// Draws the dialog for opening files, with the side panel next to the list of files.
fn draw_with_side_panel(
    ctx: &Context,
    state: &UiState,
    open_dialog: &mut OpenFileDialog,
    intents: &mut Intents,
) {
    let filters = open_dialog.purpose.filters();
    let extensions = filters
        .first()
        .map_or(&[][..], |(_, extensions)| extensions);
    let (typed, text) = (&mut open_dialog.typed, &mut open_dialog.text);
    let mut panel = |ui: &mut Ui, dialog: &mut FileDialog| {
        let last_selected = dialog.selected_entries().last();
        let entry = last_selected.or(dialog.selected_entry());
        let folder = match entry {
            Some(entry) if entry.is_dir() => Some(entry.as_path()),
            Some(entry) => entry.as_path().parent(),
            None => state.dialog.folder(),
        };
        let folder = folder.unwrap_or(Path::new("."));
        if let Some(path) = file_side_panel::field(ui, typed, folder, extensions) {
            intents.push(Intent::AnswerDialog(vec![path]));
        }
        if typed.has_completions() {
            return;
        }
        if let Some(path) = file_side_panel::text_design(ui, state, text) {
            intents.push(Intent::AnswerDialog(vec![path]));
        }
        let text = text.path();
        let file = entry.filter(|entry| entry.is_file());
        let shown = text.as_deref().or(file.map(DirectoryEntry::as_path));
        file_side_panel::preview(ui, state, shown, intents);
    };
    open_dialog
        .dialog
        .update_with_right_panel_ui(ctx, &mut panel);
}

fn dialog(purpose: &DialogPurpose, state: &UiState) -> FileDialog {
    let mut dialog = FileDialog::new()
        .title(purpose.title())
        .opening_mode(OpeningMode::AlwaysInitialDir)
        .default_size(SIZE)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .resizable(false)
        // The search field would be black in both themes; the path field of the side panel replaces
        // it.
        .show_search(false)
        // If the user selects a symbolic link, its own path is used, not that of its target.
        .canonicalize_paths(false);
    dialog.set_right_panel_width(file_side_panel::WIDTH);
    let recent = state.recent.folders();
    // The dialog starts in the folder that was used last or, without one, in the folder of the most
    // recent project.
    if let Some(folder) = state.dialog.folder().or(recent.first().copied()) {
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
    for (index, (name, extensions)) in purpose.filters().into_iter().enumerate() {
        dialog = dialog.add_file_filter_extensions(&name, extensions);
        if index == 0 {
            dialog = dialog.default_file_filter(&name);
        }
    }
    match purpose {
        DialogPurpose::Open | DialogPurpose::Second(_) | DialogPurpose::Insert(_) => {
            dialog.pick_multiple();
        }
        DialogPurpose::Replace(_) => dialog.pick_file(),
        DialogPurpose::Save(name) | DialogPurpose::Export(_, name) => {
            dialog = dialog.default_file_name(name);
            dialog.save_file();
        }
    }
    dialog
}
