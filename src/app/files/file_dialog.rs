//! The file dialog: opens it on request, and turns the chosen files into intents. The panels draw
//! the dialog inside the window.
//!
//! System dialogs are not used: they need a portal or helper program that may be missing, and then
//! report that the user cancelled.

use std::path::{Path, PathBuf};

use bevy::prelude::{Commands, MessageReader, Res, ResMut, Resource};

use crate::app::capture::export_folder::ExportFolder;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::input::intent::{ExportKind, Intent};
use crate::app::input::preferences::{FilmFileFormat, Preferences};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CaptureFolder, free_name};
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::design::{Format, extensions};
use crate::export::{FilmKind, StillKind};
use crate::project::Project;
use crate::settings::Choice;

/// Purpose for which the file dialog is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DialogPurpose {
    /// Open a project or designs.
    Open,
    /// Open this design together with others, which the dialog asks for.
    Second(PathBuf),
    /// Replace the design with this index.
    Replace(usize),
    /// Insert designs before the design with this index, or after all designs if the index equals
    /// the number of designs.
    Insert(usize),
    /// Save the project, with this suggested file name.
    Save(String),
    /// Export, with this suggested file name.
    Export(ExportKind, String),
}

impl DialogPurpose {
    /// Title of the dialog.
    #[must_use]
    pub fn title(&self) -> &'static str {
        match self {
            Self::Open => "Open a project or designs",
            Self::Second(_) => "Choose the second design",
            Self::Replace(_) => "Replace file",
            Self::Insert(_) => "Add designs",
            Self::Save(_) => "Save project",
            Self::Export(ExportKind::Film, _) => "Export film",
            Self::Export(ExportKind::MethodSheet, _) => "Export comparison sheet",
        }
    }

    /// File filters, the default first: the name of each and its extensions.
    #[must_use]
    pub fn filters(&self) -> Vec<(String, Vec<&'static str>)> {
        let projects = ("Projects".to_owned(), vec![Project::EXTENSION]);
        let formats =
            Format::ALL.map(|format| (format.name().to_owned(), format.extensions().into()));
        match self {
            Self::Save(_) => vec![projects],
            Self::Export(ExportKind::MethodSheet, _) => {
                vec![("PNG image".to_owned(), vec![StillKind::Png.name().key])]
            }
            Self::Export(ExportKind::Film, name) => {
                let format = FilmFileFormat::of_path(name.as_ref());
                let kind = format.and_then(FilmFileFormat::kind);
                let named = |kind: FilmKind| (kind.name().title.to_owned(), vec![kind.name().key]);
                kind.map(named).into_iter().collect()
            }
            Self::Second(_) | Self::Replace(_) | Self::Insert(_) => {
                let all = ("All designs".to_owned(), extensions());
                [all].into_iter().chain(formats).collect()
            }
            Self::Open => {
                let readable = [extensions(), vec![Project::EXTENSION]].concat();
                let all = ("Projects and designs".to_owned(), readable);
                [all, projects].into_iter().chain(formats).collect()
            }
        }
    }
}

/// The file dialog: its purpose while it is open, and the folder that it shows.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct FileDialogRequest {
    purpose: Option<DialogPurpose>,
    folder: Option<PathBuf>,
    /// Folder of the files that the user chose last.
    last_folder: Option<PathBuf>,
}

impl FileDialogRequest {
    /// Purpose of the dialog, while it is open.
    #[must_use]
    pub fn purpose(&self) -> Option<&DialogPurpose> {
        self.purpose.as_ref()
    }

    /// Folder that the dialog shows when it opens. A project is saved in its folder or next to its
    /// designs, and a second design is sought next to the first; otherwise it is the folder that
    /// the user chose last, or else that of the project, or else that of the user's documents.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }
}

/// Opens the dialog on intents that need a file name; does nothing if one is already open.
pub fn open(
    mut intents: MessageReader<Intent>,
    mut dialog: ResMut<FileDialogRequest>,
    session: Res<Session>,
    preferences: Res<Preferences>,
    exporter: Res<FilmExporter>,
    export_folder: ExportFolder,
) {
    for intent in intents.read() {
        let purpose = match intent {
            Intent::AskExport(kind) if exporter.work().is_none() => {
                let format = preferences.format(session.project().and_then(|of| of.content));
                let name = export_name(*kind, format, &session, &export_folder.path());
                DialogPurpose::Export(*kind, name)
            }
            Intent::AskOpen => DialogPurpose::Open,
            Intent::AskSecond(first) => DialogPurpose::Second(first.clone()),
            Intent::AskReplace(index) => DialogPurpose::Replace(*index),
            Intent::AskInsert(at) => DialogPurpose::Insert(*at),
            Intent::SaveAs => DialogPurpose::Save(project_file_name(&session.file_stem())),
            Intent::Save if session.path().is_none() => {
                DialogPurpose::Save(project_file_name(&session.file_stem()))
            }
            _ => continue,
        };
        let needs_project = !matches!(purpose, DialogPurpose::Open | DialogPurpose::Second(_));
        if dialog.purpose.is_none() && (session.project().is_some() || !needs_project) {
            dialog.folder = match purpose {
                DialogPurpose::Export(..) => Some(export_folder.path()),
                _ => first_folder(&purpose, dialog.last_folder.clone(), &session),
            };
            dialog.purpose = Some(purpose);
        }
    }
}

/// Suggested file name of an export: one that is free in `folder`.
fn export_name(
    kind: ExportKind,
    format: FilmFileFormat,
    session: &Session,
    folder: &Path,
) -> String {
    let stem = session.file_stem();
    let (stem, extension) = match kind {
        ExportKind::Film => (stem, format.extension()),
        ExportKind::MethodSheet => (format!("{stem}-methods"), Some(StillKind::Png.name().key)),
    };
    let suffix = extension.map_or_else(String::new, |extension| format!(".{extension}"));
    free_name(folder, &stem, &suffix)
}

/// Folder that the dialog shows first. `last` is the folder that the user chose last.
fn first_folder(
    purpose: &DialogPurpose,
    last: Option<PathBuf>,
    session: &Session,
) -> Option<PathBuf> {
    match purpose {
        DialogPurpose::Second(first) => parent(first),
        DialogPurpose::Save(_) => session.folder(),
        _ => None,
    }
    .or(last)
    .or_else(|| session.folder())
    .or_else(default_folder)
}

/// Folder that contains a file; `None` for a path without a folder.
fn parent(file: &Path) -> Option<PathBuf> {
    let folder = file.parent().filter(|folder| folder.is_dir());
    folder.map(Path::to_owned)
}

/// The user's documents, or the home folder.
fn default_folder() -> Option<PathBuf> {
    let documents = dirs::document_dir().filter(|folder| folder.is_dir());
    documents.or_else(dirs::home_dir)
}

/// File name of a project with this stem.
fn project_file_name(stem: &str) -> String {
    format!("{stem}.{}", Project::EXTENSION)
}

/// Turns the chosen files into intents; an empty choice means that the dialog was cancelled.
pub fn apply_choice(
    mut intents: MessageReader<Intent>,
    mut dialog: ResMut<FileDialogRequest>,
    mut question: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut capture_folder: ResMut<CaptureFolder>,
    mut commands: Commands,
) {
    for intent in intents.read() {
        let Intent::AnswerDialog(paths) = intent else {
            continue;
        };
        let (purpose, first) = (dialog.purpose.take(), paths.first());
        notices.resolve(NoticeTopic::FileName);
        let is_export = matches!(purpose, Some(DialogPurpose::Export(..)));
        match first.and_then(|path| parent(path)) {
            Some(folder) if is_export => capture_folder.choose(&folder),
            Some(folder) => dialog.last_folder = Some(folder),
            None => {}
        }
        match (purpose, first) {
            (Some(DialogPurpose::Save(_)), None) => {
                notices.note("Save cancelled");
                question.save_cancelled();
            }
            (None, _) | (_, None) => {}
            (Some(DialogPurpose::Open), Some(_)) => {
                commands.write_message(Intent::Open(paths.clone()));
            }
            (Some(DialogPurpose::Second(design)), Some(_)) => {
                let designs = [design].into_iter().chain(paths.iter().cloned());
                commands.write_message(Intent::Open(designs.collect()));
            }
            (Some(DialogPurpose::Replace(index)), Some(path)) => {
                commands.write_message(Intent::ReplaceDesign(index, path.clone()));
            }
            (Some(DialogPurpose::Insert(at)), Some(_)) => {
                commands.write_message(Intent::InsertDesigns(at, paths.clone()));
            }
            (Some(DialogPurpose::Export(kind, _)), Some(path)) => {
                commands.write_message(Intent::Export(kind, path.clone()));
            }
            (Some(DialogPurpose::Save(_)), Some(path)) => match confirmed_path(path) {
                Ok(full_path) => {
                    commands.write_message(Intent::SaveTo(full_path));
                }
                Err(existing) => {
                    let name = existing.file_name().unwrap_or_default().to_string_lossy();
                    let text = format!(
                        "{} already exists. Select it to replace it, or choose another name",
                        existing.display()
                    );
                    notices.problem(NoticeTopic::FileName, text);
                    dialog.purpose = Some(DialogPurpose::Save(name.into_owned()));
                }
            },
        }
    }
}

/// Returns the path under which a project is saved, with its extension; as an error if the user has
/// not confirmed that a file there is replaced. The dialog checks only the name without extension.
fn confirmed_path(path: &Path) -> Result<PathBuf, PathBuf> {
    let full_path = with_extension(path);
    match full_path != *path && full_path.exists() {
        true => Err(full_path),
        false => Ok(full_path),
    }
}

/// Path with the extension of project files, appended if it is missing.
fn with_extension(path: &Path) -> PathBuf {
    if Project::has_document_extension(path) {
        path.to_owned()
    } else {
        path.with_added_extension(Project::EXTENSION)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialogs_show_every_importable_file() {
        for purpose in [DialogPurpose::Open, DialogPurpose::Replace(0)] {
            let filters = purpose.filters();
            let (_, extensions) = &filters[0];
            for format in Format::ALL {
                let read = format.extensions();
                assert!(
                    read.iter().all(|e| extensions.contains(e)),
                    "{}",
                    format.name()
                );
                assert!(filters.iter().any(|(name, _)| name == format.name()));
            }
        }
    }

    #[test]
    fn the_extension_is_added_once() {
        assert_eq!(with_extension(Path::new("a")), Path::new("a.morph"));
        assert_eq!(with_extension(Path::new("a.b")), Path::new("a.b.morph"));
        assert_eq!(with_extension(Path::new("a.MORPH")), Path::new("a.MORPH"));
    }
}
