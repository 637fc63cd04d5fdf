//! Nothing that was not saved is lost without a question.
//!
//! Closing the window and opening another project go through here: a [`UnsavedQuestion`] holds
//! them back where something would be lost, asks, and sends them on again once it is decided.

use bevy::prelude::{
    AppExit, Commands, MessageReader, MessageWriter, Query, Res, ResMut, Resource, With, Without,
};
use bevy::window::{PrimaryWindow, Window, WindowCloseRequested};

use crate::app::capture::film_exporter::FilmExporter;
use crate::app::input::intent::{Intent, UnsavedAnswer};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::state::Session;

/// What would be lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedKind {
    /// Changes of the project.
    Changes,
    /// A film that is being written.
    Film,
}

/// What is held back, and why.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct UnsavedQuestion {
    held: Option<PendingIntent>,
}

#[derive(Clone, Debug, PartialEq)]
struct PendingIntent {
    intent: Intent,
    lost: UnsavedKind,
    /// It was answered: the act goes on when the project is saved, or the film has ended.
    is_answered: bool,
    text: String,
}

impl UnsavedQuestion {
    /// What to ask, while a question is open.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        let held = self.held.as_ref().filter(|held| !held.is_answered)?;
        Some(&held.text)
    }

    /// What would be lost, while something is held back.
    #[must_use]
    pub fn lost(&self) -> Option<UnsavedKind> {
        self.held.as_ref().map(|held| held.lost)
    }

    /// Holds an act back and asks.
    pub fn ask(&mut self, intent: Intent, lost: UnsavedKind, text: String) {
        self.held = Some(PendingIntent {
            intent,
            lost,
            is_answered: false,
            text,
        });
    }

    /// What would have been lost is safe now: what waited for it goes on.
    pub fn safe(&mut self, lost: UnsavedKind) -> Option<Intent> {
        let waits = |held: &mut PendingIntent| held.is_answered && held.lost == lost;
        Some(self.held.take_if(waits)?.intent)
    }

    /// The project was not saved after all: what waited for it is dropped.
    pub fn not_saved(&mut self) {
        self.safe(UnsavedKind::Changes);
    }
}

/// Turns the window's wish to close into an intent.
pub fn read_close_requests(
    mut requests: MessageReader<WindowCloseRequested>,
    others: Query<(), (With<Window>, Without<PrimaryWindow>)>,
    mut intents: MessageWriter<Intent>,
) {
    // The speaker's window only closes itself.
    let is_all = |request: &&WindowCloseRequested| !others.contains(request.window);
    if requests.read().filter(is_all).count() > 0 {
        intents.write(Intent::Close);
    }
}

/// Closes the window, or asks first.
pub fn close(
    mut intents: MessageReader<Intent>,
    session: Res<Session>,
    recorder: Res<FilmExporter>,
    mut question: ResMut<UnsavedQuestion>,
    mut exit: MessageWriter<AppExit>,
) {
    for intent in intents.read() {
        if *intent != Intent::Close {
            continue;
        }
        if session.is_dirty() {
            question.ask(Intent::Close, UnsavedKind::Changes, session.unsaved_text());
        } else if recorder.work().is_some() {
            let text = "It would be lost.".to_owned();
            question.ask(Intent::Close, UnsavedKind::Film, text);
        } else {
            exit.write(AppExit::Success);
        }
    }
}

/// Acts on the answer.
pub fn answer(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    (recorder, notices): (Res<FilmExporter>, Res<Notices>),
    mut question: ResMut<UnsavedQuestion>,
    mut commands: Commands,
) {
    let mut next = Vec::new();
    for intent in intents.read() {
        match intent {
            Intent::Answer(UnsavedAnswer::Stay) | Intent::Back => {
                // Once it is answered, Esc is meant for something else.
                question.held.take_if(|held| !held.is_answered);
            }
            Intent::Answer(answer) => {
                if let Some(held) = &mut question.held {
                    held.is_answered = true;
                    match (held.lost, answer) {
                        // A save may ask for a place first and take long; the act waits until it is
                        // told of its end.
                        (UnsavedKind::Changes, UnsavedAnswer::Save) => next.push(Intent::Save),
                        (UnsavedKind::Changes, _) => {
                            // Else what is sent on would be asked about once more.
                            session.forget_changes();
                            next.extend(question.safe(UnsavedKind::Changes));
                        }
                        (UnsavedKind::Film, UnsavedAnswer::Save) => {}
                        // It takes away what it has begun, and that is waited for.
                        (UnsavedKind::Film, _) => recorder.cancel(),
                    }
                }
            }
            _ => {}
        }
    }
    // A film that came to nothing is told of, which takes the window.
    if recorder.work().is_none()
        && question.lost() == Some(UnsavedKind::Film)
        && let Some(intent) = question.safe(UnsavedKind::Film)
        && !notices.is_ill(NoticeTopic::Film)
    {
        next.push(intent);
    }
    for intent in next {
        commands.write_message(intent);
    }
}
