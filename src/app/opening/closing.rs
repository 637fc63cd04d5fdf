//! Nothing that was not saved is lost without a question.
//!
//! Closing the window and opening another project go through here: a [`Question`] holds
//! them back where changes would be lost, asks, and sends them on again once it is decided.

use bevy::prelude::{AppExit, Commands, MessageReader, MessageWriter, Res, ResMut, Resource};
use bevy::window::WindowCloseRequested;

use crate::app::asking::intent::{Answer, Intent};
use crate::app::capturing::films::Recorder;
use crate::app::session::state::Session;

/// What is held back, and why.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Question {
    held: Option<Held>,
}

#[derive(Clone, Debug, PartialEq)]
struct Held {
    intent: Intent,
    waits_for_save: bool,
    text: String,
}

impl Question {
    /// What to ask, while a question is open.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        let held = self.held.as_ref().filter(|held| !held.waits_for_save)?;
        Some(&held.text)
    }

    /// Holds an act back and asks.
    pub fn ask(&mut self, intent: Intent, text: String) {
        self.held = Some(Held {
            intent,
            waits_for_save: false,
            text,
        });
    }

    /// The project has just been saved: what waited for it goes on.
    pub fn after_save(&mut self) -> Option<Intent> {
        let waiting = self.held.take_if(|held| held.waits_for_save)?;
        Some(waiting.intent)
    }

    /// The project was not saved after all: what waited for it is dropped.
    pub fn not_saved(&mut self) {
        self.held.take_if(|held| held.waits_for_save);
    }
}

/// Turns the window's wish to close into an intent.
pub fn read_close_requests(
    mut requests: MessageReader<WindowCloseRequested>,
    mut intents: MessageWriter<Intent>,
) {
    if requests.read().count() > 0 {
        intents.write(Intent::Close);
    }
}

/// Closes the window, or asks first.
pub fn close(
    mut intents: MessageReader<Intent>,
    session: Res<Session>,
    recorder: Res<Recorder>,
    mut question: ResMut<Question>,
    mut exit: MessageWriter<AppExit>,
) {
    for intent in intents.read() {
        if *intent != Intent::Close {
            continue;
        }
        if session.is_dirty() {
            question.ask(Intent::Close, session.unsaved_text());
        } else if recorder.work().is_some() {
            question.ask(
                Intent::Close,
                "A film is still being written; it would be lost.".into(),
            );
        } else {
            exit.write(AppExit::Success);
        }
    }
}

/// Acts on the answer.
pub fn answer(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    recorder: Res<Recorder>,
    mut question: ResMut<Question>,
    mut commands: Commands,
) {
    let mut next = Vec::new();
    for intent in intents.read() {
        match intent {
            Intent::Answer(Answer::Stay) | Intent::Back => {
                // Once a save is under way the question is answered: Esc is meant for something
                // else.
                question.held.take_if(|held| !held.waits_for_save);
            }
            Intent::Answer(Answer::Discard) => {
                if let Some(held) = question.held.take() {
                    // Else what is sent on would be asked about once more.
                    session.forget_changes();
                    recorder.cancel();
                    next.push(held.intent);
                }
            }
            Intent::Answer(Answer::Save) => {
                if let Some(held) = &mut question.held {
                    // A save may ask for a place first and take long; the act waits until it is
                    // told of its end.
                    held.waits_for_save = true;
                    next.push(Intent::Save);
                }
            }
            _ => {}
        }
    }
    for intent in next {
        commands.write_message(intent);
    }
}
