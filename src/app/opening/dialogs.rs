//! Files that the user points at: in the system's dialogs, or by dropping them on the window.
//!
//! A dialog never blocks the stage. It is made on the main thread, as macOS demands, and waited
//! for on a thread of its own.

use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy::ecs::system::NonSendMarker;
use bevy::prelude::{MessageReader, MessageWriter, Res, ResMut, Resource, Time};
use bevy::tasks::block_on;
use bevy::window::FileDragAndDrop;
use rfd::{AsyncFileDialog, FileHandle};

use crate::app::asking::intent::Intent;
use crate::app::capturing::files::{CaptureFolder, NewFileError, create_new};
use crate::app::opening::closing::Question;
use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::app::telling::notices::{About, Notices};
use crate::design::extensions;
use crate::project::Project;

/// Files that are dropped together arrive one by one; so long is waited for the next.
const GATHER_SECS: f32 = 0.15;

/// A dialog that is gone after less time than this was never seen: the system has none to show.
/// Nobody reads, decides and cancels that fast.
const UNSEEN: Duration = Duration::from_millis(400);

/// What the dialog that is open is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    Open,
    Replace(usize),
    Save,
}

/// The dialog that is open, if any; never more than one.
#[derive(Resource, Debug, Default)]
pub struct Dialog(Option<(Purpose, Answer)>);

/// The files that are chosen; none where the dialog is left.
type Answer = Job<Vec<PathBuf>, Infallible>;

impl Dialog {
    /// A dialog is open.
    pub fn is_open(&self) -> bool {
        self.0.is_some()
    }
}

/// Opens dialogs.
pub fn open(
    mut intents: MessageReader<Intent>,
    mut dialog: ResMut<Dialog>,
    session: Res<Session>,
    _main_thread: NonSendMarker,
) {
    for intent in intents.read() {
        let purpose = match intent {
            Intent::AskOpen => Purpose::Open,
            Intent::AskReplace(index) => Purpose::Replace(*index),
            Intent::SaveAs => Purpose::Save,
            Intent::Save if session.path().is_none() => Purpose::Save,
            _ => continue,
        };
        let applies = session.project().is_some() || purpose == Purpose::Open;
        if dialog.0.is_none() && applies {
            dialog.0 = Some((purpose, start(purpose, &session)));
        }
    }
}

fn start(purpose: Purpose, session: &Session) -> Answer {
    let (title, kind, extensions) = purpose.asks();
    let asked = AsyncFileDialog::new()
        .set_title(title)
        .add_filter(kind, &extensions);
    match purpose {
        Purpose::Open => wait_for(asked.pick_files()),
        Purpose::Replace(_) => {
            let file = asked.pick_file();
            wait_for(async { file.await.map(|file| vec![file]) })
        }
        Purpose::Save => {
            let name = format!("{}.{}", session.file_stem(), Project::EXTENSION);
            let file = asked.set_file_name(name).save_file();
            wait_for(async { file.await.map(|file| vec![file]) })
        }
    }
}

impl Purpose {
    /// The title of the dialog, what files it shows, and how their names end.
    fn asks(self) -> (&'static str, &'static str, Vec<&'static str>) {
        let project = vec![Project::EXTENSION];
        match self {
            Self::Open => (
                "Open a project, or one or two designs",
                "Projects and designs",
                [extensions(), project].concat(),
            ),
            Self::Replace(_) => ("Choose a design", "Designs", extensions()),
            Self::Save => ("Save the project", "Projects", project),
        }
    }
}

/// Waits beside the window until the dialog is closed.
fn wait_for(asked: impl Future<Output = Option<Vec<FileHandle>>> + Send + 'static) -> Answer {
    Job::start("the dialog", move |_| {
        let files = block_on(asked).unwrap_or_default();
        Ok(files.iter().map(|file| file.path().to_owned()).collect())
    })
}

/// Takes in what was chosen.
pub fn finish(
    mut dialog: ResMut<Dialog>,
    mut question: ResMut<Question>,
    mut notices: ResMut<Notices>,
    mut intents: MessageWriter<Intent>,
    (session, folder): (Res<Session>, Res<CaptureFolder>),
) {
    let answered = |(purpose, job): &(Purpose, Answer)| Some((*purpose, job.lasts(), job.poll()?));
    let Some((purpose, lasted, answer)) = dialog.0.as_ref().and_then(answered) else {
        return;
    };
    dialog.0 = None;
    let paths = answer.unwrap_or_else(|broken| {
        notices.problem(About::Opening, broken.to_string());
        Vec::new()
    });
    let is_unseen = paths.is_empty() && lasted < UNSEEN;
    match (purpose, paths.first()) {
        (Purpose::Save, None) if is_unseen => match place_without_asking(&session, &folder) {
            Ok(path) => {
                notices.problem(About::Saving, NO_DIALOG_TO_SAVE);
                intents.write(Intent::SaveTo(path));
            }
            Err(error) => {
                notices.problem(About::Saving, error.to_string());
                question.not_saved();
            }
        },
        // Left without a choice: what waited for the save does not go on.
        (Purpose::Save, None) => question.not_saved(),
        (_, None) if is_unseen => notices.problem(About::Opening, NO_DIALOG_TO_OPEN),
        (_, None) => {}
        (Purpose::Save, Some(path)) => {
            intents.write(Intent::SaveTo(with_extension(path)));
        }
        (Purpose::Replace(index), Some(path)) => {
            intents.write(Intent::ReplaceDesign(index, path.clone()));
        }
        (Purpose::Open, Some(_)) => {
            intents.write(Intent::Open(paths));
        }
    }
}

const NO_DIALOG_TO_OPEN: &str = "The system shows no file dialog (on Linux, install \
    xdg-desktop-portal or zenity). Drop files on the window instead, or name them on the command line.";

const NO_DIALOG_TO_SAVE: &str = "The system shows no file dialog (on Linux, install \
    xdg-desktop-portal or zenity), so the project goes where pictures go.";

/// A new name where pictures go, so that work can be kept even without a dialog.
fn place_without_asking(
    session: &Session,
    folder: &CaptureFolder,
) -> Result<PathBuf, NewFileError> {
    create_new(&folder.0, &session.file_stem(), Project::EXTENSION).map(|(_, path)| path)
}

fn with_extension(path: &Path) -> PathBuf {
    if Project::is_named(path) {
        path.to_owned()
    } else {
        path.with_added_extension(Project::EXTENSION)
    }
}

/// Files that were dropped: those still arriving, and one of which nobody knows what it is for.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Drop {
    arriving: Vec<PathBuf>,
    quiet_secs: f32,
    undecided: Option<PathBuf>,
}

impl Drop {
    /// A single design that may become source or target.
    #[must_use]
    pub fn undecided(&self) -> Option<&Path> {
        self.undecided.as_deref()
    }

    /// Files are arriving that are not acted on yet.
    #[must_use]
    pub fn is_arriving(&self) -> bool {
        !self.arriving.is_empty()
    }

    /// Asks what a single design is for.
    pub fn ask(&mut self, path: PathBuf) {
        self.undecided = Some(path);
    }
}

/// Gathers dropped files and opens them together.
pub fn read_drops(
    mut drops: MessageReader<FileDragAndDrop>,
    time: Res<Time>,
    mut state: ResMut<Drop>,
    mut intents: MessageWriter<Intent>,
) {
    for drop in drops.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = drop {
            state.arriving.push(path_buf.clone());
            state.quiet_secs = 0.0;
        }
    }
    if state.arriving.is_empty() {
        return;
    }
    state.quiet_secs += time.delta_secs();
    if state.quiet_secs >= GATHER_SECS {
        intents.write(Intent::Open(std::mem::take(&mut state.arriving)));
    }
}

/// Forgets the undecided file once it is decided.
pub fn decide(mut intents: MessageReader<Intent>, mut state: ResMut<Drop>) {
    let is_decided = |intent: &Intent| matches!(intent, Intent::ReplaceDesign(..) | Intent::Back);
    if intents.read().any(is_decided) && state.undecided.is_some() {
        state.undecided = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialogs_show_whatever_an_importer_reads() {
        for purpose in [Purpose::Open, Purpose::Replace(0)] {
            let (_, _, shown) = purpose.asks();
            for format in crate::design::Format::ALL {
                let read = format.extensions();
                assert!(read.iter().all(|e| shown.contains(e)), "{}", format.name());
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
