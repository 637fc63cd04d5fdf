//! Asks before unsaved work is lost.
//!
//! Closing the window and opening another project go through an [`UnsavedQuestion`]: it holds the
//! intent back while work would be lost, and sends it again once the user has decided.

use bevy::prelude::{
    AppExit, Commands, MessageReader, MessageWriter, Query, Res, ResMut, Resource, With, Without,
};
use bevy::window::{PrimaryWindow, Window, WindowCloseRequested};

use crate::app::capture::film_exporter::FilmExporter;
use crate::app::input::intent::{Intent, UnsavedAnswer};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;

/// Kind of work that would be lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedKind {
    /// Unsaved changes of the project.
    Changes,
    /// A film being exported.
    Film,
}

/// The intent that waits for an answer, if any.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct UnsavedQuestion {
    pending: Option<PendingIntent>,
}

/// An intent that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
struct PendingIntent {
    intent: Intent,
    kind: UnsavedKind,
    /// Whether the user answered “save” or “wait”. The intent is then sent again after the save or
    /// export.
    is_answered: bool,
    text: String,
}

impl UnsavedQuestion {
    /// Text of the open question; `None` if no question is open.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        let pending = self
            .pending
            .as_ref()
            .filter(|pending| !pending.is_answered)?;
        Some(&pending.text)
    }

    /// Kind of work that the waiting intent would lose; `None` if no intent waits. It remains the
    /// same after the user's answer, while the intent waits for the save or export.
    #[must_use]
    pub fn kind(&self) -> Option<UnsavedKind> {
        self.pending.as_ref().map(|pending| pending.kind)
    }

    /// Holds an intent back and opens a question with this text.
    pub fn ask(&mut self, intent: Intent, kind: UnsavedKind, text: String) {
        self.pending = Some(PendingIntent {
            intent,
            kind,
            is_answered: false,
            text,
        });
    }

    /// Takes the intent that waited for this kind of work; to be called once the work has been
    /// saved or discarded. `None` if no answered question waits for it.
    pub fn take_if_resolved(&mut self, kind: UnsavedKind) -> Option<Intent> {
        let waits = |pending: &mut PendingIntent| pending.is_answered && pending.kind == kind;
        Some(self.pending.take_if(waits)?.intent)
    }

    /// Drops the intent that waited for a save; to be called when saving was cancelled or failed.
    pub fn save_cancelled(&mut self) {
        self.take_if_resolved(UnsavedKind::Changes);
    }
}

/// Turns the system's request to close the main window into [`Intent::Close`].
pub fn read_close_requests(
    mut requests: MessageReader<WindowCloseRequested>,
    others: Query<(), (With<Window>, Without<PrimaryWindow>)>,
    mut intents: MessageWriter<Intent>,
) {
    // Closing the speaker window does not close the application.
    let is_main_window = |request: &&WindowCloseRequested| !others.contains(request.window);
    if requests.read().filter(is_main_window).count() > 0 {
        intents.write(Intent::Close);
    }
}

/// Closes the window, or asks first if unsaved changes or a running export would be lost.
pub fn close(
    mut intents: MessageReader<Intent>,
    session: Res<Session>,
    exporter: Res<FilmExporter>,
    mut question: ResMut<UnsavedQuestion>,
    mut exit: MessageWriter<AppExit>,
) {
    for intent in intents.read() {
        if *intent != Intent::Close {
            continue;
        }
        if session.is_dirty() {
            question.ask(Intent::Close, UnsavedKind::Changes, session.unsaved_text());
        } else if exporter.work().is_some() {
            let text = "Closing now would stop the export.".to_owned();
            question.ask(Intent::Close, UnsavedKind::Film, text);
        } else {
            exit.write(AppExit::Success);
        }
    }
}

/// Applies the user's answer.
pub fn answer(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    exporter: Res<FilmExporter>,
    notices: Res<Notices>,
    mut question: ResMut<UnsavedQuestion>,
    conflict: Res<ConflictQuestion>,
    mut commands: Commands,
) {
    let mut next = Vec::new();
    for intent in intents.read() {
        match intent {
            // Esc closes only the topmost question.
            Intent::Escape if conflict.is_open() => {}
            Intent::AnswerUnsaved(UnsavedAnswer::Cancel) | Intent::Escape => {
                // Esc cancels an open question only; once answered, the intent keeps waiting.
                question.pending.take_if(|pending| !pending.is_answered);
            }
            Intent::AnswerUnsaved(answer) => {
                if let Some(pending) = &mut question.pending {
                    pending.is_answered = true;
                    match (pending.kind, answer) {
                        // Saving may open a dialog and take long; the intent waits for the result.
                        (UnsavedKind::Changes, UnsavedAnswer::Save) => next.push(Intent::Save),
                        (UnsavedKind::Changes, _) => {
                            // Otherwise the intent would raise the same question when it is sent
                            // again.
                            session.mark_saved();
                            next.extend(question.take_if_resolved(UnsavedKind::Changes));
                        }
                        // The intent waits for the export to end.
                        (UnsavedKind::Film, UnsavedAnswer::Save) => {}
                        // The user discards the film, so the export is cancelled. It then deletes
                        // its partial file; the intent waits until that is done.
                        (UnsavedKind::Film, _) => exporter.cancel(),
                    }
                }
            }
            _ => {}
        }
    }
    // After a failed export the window stays open to show the reason.
    if exporter.work().is_none()
        && question.kind() == Some(UnsavedKind::Film)
        && let Some(intent) = question.take_if_resolved(UnsavedKind::Film)
        && !notices.has_problem(NoticeTopic::Film)
    {
        next.push(intent);
    }
    for intent in next {
        commands.write_message(intent);
    }
}
