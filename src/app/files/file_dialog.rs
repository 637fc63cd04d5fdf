//! Files that the user points at, in a dialog of the window's own.
//!
//! The system's dialogs hang on a portal or a program that may not be there, and then answer as
//! if they had been left. Here is what is asked for and what comes of the answer; the panels draw
//! it.

use std::path::{Path, PathBuf};

use bevy::prelude::{Commands, MessageReader, Res, ResMut, Resource};

use crate::app::input::intent::Intent;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::design::{Format, extensions};
use crate::project::Project;

/// What files are asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DialogPurpose {
    /// A project, or designs.
    Open,
    /// A design that takes the place of that of this number.
    Replace(usize),
    /// Designs that come before that of this number, or after all.
    Insert(usize),
    /// A place for the project, which may be called so.
    Save(String),
}

impl DialogPurpose {
    /// The title of the dialog.
    #[must_use]
    pub fn title(&self) -> &'static str {
        match self {
            Self::Open => "Open a project, or designs",
            Self::Replace(_) => "Choose a design",
            Self::Insert(_) => "Add designs",
            Self::Save(_) => "Save the project",
        }
    }

    /// The kinds of files that it shows, the first one from the start, and how their names end.
    #[must_use]
    pub fn filters(&self) -> Vec<(String, Vec<&'static str>)> {
        let projects = ("Projects".to_owned(), vec![Project::EXTENSION]);
        let formats =
            Format::ALL.map(|format| (format.name().to_owned(), format.extensions().into()));
        match self {
            Self::Save(_) => vec![projects],
            Self::Replace(_) | Self::Insert(_) => {
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

/// The dialog that is open, if any; never more than one.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct FileDialogRequest {
    asks: Option<DialogPurpose>,
    folder: Option<PathBuf>,
}

impl FileDialogRequest {
    /// What it is for, while it is open.
    #[must_use]
    pub fn asks(&self) -> Option<&DialogPurpose> {
        self.asks.as_ref()
    }

    /// The folder that something was last chosen from.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }
}

/// Opens dialogs.
pub fn open(
    mut intents: MessageReader<Intent>,
    mut dialog: ResMut<FileDialogRequest>,
    session: Res<Session>,
) {
    for intent in intents.read() {
        let asks = match intent {
            Intent::AskOpen => DialogPurpose::Open,
            Intent::AskReplace(index) => DialogPurpose::Replace(*index),
            Intent::AskInsert(at) => DialogPurpose::Insert(*at),
            Intent::SaveAs => DialogPurpose::Save(named(&session.file_stem())),
            Intent::Save if session.path().is_none() => {
                DialogPurpose::Save(named(&session.file_stem()))
            }
            _ => continue,
        };
        let applies = session.project().is_some() || asks == DialogPurpose::Open;
        if dialog.asks.is_none() && applies {
            dialog.asks = Some(asks);
            // Where the project lies, until something was chosen elsewhere.
            let beside = session.path().and_then(Path::parent).map(Path::to_owned);
            dialog.folder = dialog.folder.take().or(beside).or_else(usual_folder);
        }
    }
}

fn usual_folder() -> Option<PathBuf> {
    let documents = dirs::document_dir().filter(|folder| folder.is_dir());
    documents.or_else(dirs::home_dir)
}

fn named(stem: &str) -> String {
    format!("{stem}.{}", Project::EXTENSION)
}

/// Takes in what was chosen; nothing where the dialog was left.
pub fn choose(
    mut intents: MessageReader<Intent>,
    mut dialog: ResMut<FileDialogRequest>,
    mut question: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    for intent in intents.read() {
        let Intent::Choose(paths) = intent else {
            continue;
        };
        let (asks, first) = (dialog.asks.take(), paths.first());
        if let Some(folder) = first.and_then(|path| path.parent()) {
            dialog.folder = Some(folder.to_owned());
        }
        match (asks, first) {
            (Some(DialogPurpose::Save(_)), None) => {
                notices.done("The project was not saved.");
                question.not_saved();
            }
            (None, _) | (_, None) => {}
            (Some(DialogPurpose::Open), Some(_)) => {
                commands.write_message(Intent::Open(paths.clone()));
            }
            (Some(DialogPurpose::Replace(index)), Some(path)) => {
                commands.write_message(Intent::ReplaceDesign(index, path.clone()));
            }
            (Some(DialogPurpose::Insert(at)), Some(_)) => {
                commands.write_message(Intent::InsertDesigns(at, paths.clone()));
            }
            (Some(DialogPurpose::Save(_)), Some(path)) => match with_extension(path) {
                // Asked about another file than that which would be lost.
                whole if whole != *path && whole.exists() => {
                    let name = whole.file_name().unwrap_or_default().to_string_lossy();
                    notices.problem(
                        NoticeTopic::Saving,
                        format!(
                            "{} is there already: choose it to replace it, or another name.",
                            whole.display()
                        ),
                    );
                    dialog.asks = Some(DialogPurpose::Save(name.into_owned()));
                }
                whole => {
                    commands.write_message(Intent::SaveTo(whole));
                }
            },
        }
    }
}

fn with_extension(path: &Path) -> PathBuf {
    if Project::is_named(path) {
        path.to_owned()
    } else {
        path.with_added_extension(Project::EXTENSION)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialogs_show_whatever_an_importer_reads() {
        for purpose in [DialogPurpose::Open, DialogPurpose::Replace(0)] {
            let filters = purpose.filters();
            let (_, shown) = &filters[0];
            for format in Format::ALL {
                let read = format.extensions();
                assert!(read.iter().all(|e| shown.contains(e)), "{}", format.name());
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
