//! What the program has to say: errors stay until they are read or what they are about is well
//! again, confirmations pass.

use std::path::PathBuf;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource, Time};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::io::sanitize::SanitizedLine;

/// How long a confirmation stays: long enough to read the path of a file.
const CONFIRMATION_SECS: f32 = 6.0;

/// How long a note stays, which is longer, and what can be acted on.
const NOTE_SECS: f32 = 10.0;

/// What a problem is about: when that is well again, it goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeTopic {
    /// Files that were to be opened.
    Opening,
    /// The settings make no transition.
    Transition,
    /// The project is not saved.
    Saving,
    /// A film, or a sheet of all methods.
    Film,
    /// A picture.
    Picture,
}

/// What a notice is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something went wrong; stays until read.
    Problem(NoticeTopic),
    /// Something was done; passes.
    Done,
    /// A file was written; passes, after some time to go to it.
    Wrote,
    /// Something that its reader may not expect; passes.
    Note,
}

impl NoticeKind {
    /// How long it stays; none for what stays until it is read.
    fn stays_secs(self) -> Option<f32> {
        match self {
            Self::Problem(_) => None,
            Self::Done => Some(CONFIRMATION_SECS),
            Self::Note | Self::Wrote => Some(NOTE_SECS),
        }
    }
}

/// One thing to say.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// By which it is dismissed.
    pub id: u64,
    /// A problem or a confirmation.
    pub kind: NoticeKind,
    /// One sentence.
    pub text: String,
    /// The file that it is about, which can be shown in its folder.
    pub file: Option<PathBuf>,
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
    pub fn problem(&mut self, about: NoticeTopic, text: impl Into<String>) {
        self.push(NoticeKind::Problem(about), text.into());
    }

    /// Says that something was done.
    pub fn done(&mut self, text: impl Into<String>) {
        self.push(NoticeKind::Done, text.into());
    }

    /// Says that a file was written.
    pub fn wrote(&mut self, file: PathBuf) {
        self.push(NoticeKind::Wrote, format!("Wrote {}", file.display()));
        if let Some(notice) = self.list.last_mut() {
            notice.file = Some(file);
        }
    }

    /// Says what may not be expected.
    pub fn note(&mut self, text: impl Into<String>) {
        self.push(NoticeKind::Note, text.into());
    }

    /// There is a problem about this.
    #[must_use]
    pub fn is_ill(&self, about: NoticeTopic) -> bool {
        let kind = NoticeKind::Problem(about);
        self.list.iter().any(|notice| notice.kind == kind)
    }

    /// This is well again: its problems go.
    pub fn well(&mut self, about: NoticeTopic) {
        let kind = NoticeKind::Problem(about);
        self.list.retain(|notice| notice.kind != kind);
    }

    /// What is to be shown, oldest first.
    #[must_use]
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    fn push(&mut self, kind: NoticeKind, text: String) {
        let text = SanitizedLine(text).to_string();
        // Said again it is the newest: it moves to the end, and its time begins anew.
        self.list.retain(|notice| notice.text != text);
        self.next_id += 1;
        self.list.push(Notice {
            id: self.next_id,
            kind,
            text,
            file: None,
            age_secs: 0.0,
        });
    }

    /// Something is on its way out.
    #[must_use]
    pub fn is_passing(&self) -> bool {
        self.list
            .iter()
            .any(|notice| notice.kind.stays_secs().is_some())
    }

    /// Whether anything has passed.
    fn pass(&mut self, secs: f32) -> bool {
        for notice in &mut self.list {
            notice.age_secs += secs;
        }
        let before = self.list.len();
        self.list.retain(|notice| {
            notice
                .kind
                .stays_secs()
                .is_none_or(|stays| notice.age_secs < stays)
        });
        self.list.len() < before
    }
}

/// Takes away what was dismissed and what has passed. While the panels are hidden nothing passes:
/// it has not been seen.
pub fn apply(
    mut intents: MessageReader<Intent>,
    time: Res<Time>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        if let Intent::Dismiss(id) = intent {
            notices.list.retain(|notice| notice.id != *id);
        }
    }
    // Growing older is no change that anybody sees.
    let now = notices.bypass_change_detection();
    if preferences.panels && now.pass(time.delta_secs()) {
        notices.set_changed();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_stay_until_what_they_are_about_is_well_and_confirmations_pass() {
        let mut notices = Notices::default();
        notices.problem(NoticeTopic::Saving, "lost");
        notices.problem(NoticeTopic::Film, "dark");
        notices.done("saved");
        assert!(notices.pass(1e4) && !notices.pass(1e4));
        assert_eq!(notices.list().len(), 2);
        notices.well(NoticeTopic::Film);
        assert_eq!(notices.list().len(), 1);
        assert_eq!(notices.list()[0].text, "lost");
        assert!(notices.is_ill(NoticeTopic::Saving) && !notices.is_ill(NoticeTopic::Film));
    }

    #[test]
    fn the_same_thing_is_said_once() {
        let mut notices = Notices::default();
        notices.problem(NoticeTopic::Saving, "lost");
        notices.problem(NoticeTopic::Saving, "lost");
        assert_eq!(notices.list().len(), 1);
    }
}
