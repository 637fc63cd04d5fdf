//! What the program has to say: errors stay until they are read, confirmations pass.

use bevy::prelude::{MessageReader, Res, ResMut, Resource, Time};

use crate::app::asking::intent::Intent;
use crate::one_line::OneLine;

/// How long a confirmation stays: long enough to read the path of a file.
const CONFIRMATION_SECS: f32 = 6.0;

/// What a notice is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Something went wrong; stays until read.
    Problem,
    /// Something was done; passes.
    Done,
}

/// One thing to say.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// By which it is dismissed.
    pub id: u64,
    /// A problem or a confirmation.
    pub kind: Kind,
    /// One sentence.
    pub text: String,
    age_secs: f32,
}

/// Everything that was said and not yet read.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Notices {
    list: Vec<Notice>,
    next_id: u64,
}

impl Notices {
    /// Says that something went wrong. What is already on screen is not said twice.
    pub fn problem(&mut self, text: impl Into<String>) {
        self.push(Kind::Problem, text.into());
    }

    /// Says that something was done.
    pub fn done(&mut self, text: impl Into<String>) {
        self.push(Kind::Done, text.into());
    }

    /// What is to be shown, oldest first.
    #[must_use]
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    fn push(&mut self, kind: Kind, text: String) {
        let text = OneLine(text).to_string();
        // Said again it is the newest: it moves to the end, and its time begins anew.
        self.list.retain(|notice| notice.text != text);
        self.next_id += 1;
        self.list.push(Notice {
            id: self.next_id,
            kind,
            text,
            age_secs: 0.0,
        });
    }

    fn pass(&mut self, secs: f32) {
        for notice in &mut self.list {
            notice.age_secs += secs;
        }
        self.list
            .retain(|notice| notice.kind == Kind::Problem || notice.age_secs < CONFIRMATION_SECS);
    }
}

/// Takes away what was dismissed and what has passed.
pub fn apply(mut intents: MessageReader<Intent>, time: Res<Time>, mut notices: ResMut<Notices>) {
    for intent in intents.read() {
        if let Intent::Dismiss(id) = intent {
            notices.list.retain(|notice| notice.id != *id);
        }
    }
    if !notices.list.is_empty() {
        notices.pass(time.delta_secs());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_stay_and_confirmations_pass() {
        let mut notices = Notices::default();
        notices.problem("lost");
        notices.done("saved");
        notices.pass(1e4);
        assert_eq!(notices.list().len(), 1);
        assert_eq!(notices.list()[0].text, "lost");
    }

    #[test]
    fn the_same_thing_is_said_once() {
        let mut notices = Notices::default();
        notices.problem("lost");
        notices.problem("lost");
        assert_eq!(notices.list().len(), 1);
    }
}
