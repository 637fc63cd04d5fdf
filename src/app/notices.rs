//! Notices shown to the user. Problems stay until they are dismissed or resolved; confirmations
//! disappear after some seconds.

use std::path::PathBuf;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource, Time};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::io::sanitize::SanitizedLine;

/// Seconds for which a confirmation stays (heuristic: long enough to read a file path).
const CONFIRMATION_SECS: f32 = 6.0;

/// Seconds for which notes and notices with a button stay; they take longer to read (heuristic).
const NOTE_SECS: f32 = 10.0;

/// Topic of a problem; all problems of a topic disappear when it is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeTopic {
    /// Opening files.
    Opening,
    /// Building the transition from the current settings.
    Transition,
    /// Saving the project.
    Saving,
    /// Exporting a film or a comparison sheet.
    Film,
    /// Saving or copying an image.
    Picture,
}

/// Kind of notice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something went wrong; stays until dismissed or resolved.
    Problem(NoticeTopic),
    /// Something succeeded; disappears.
    Confirmation,
    /// A file was written; disappears after enough time to click the link to its folder.
    FileWritten,
    /// Information that the user may not expect; disappears.
    Note,
}

impl NoticeKind {
    /// Seconds for which it stays; `None` for problems.
    fn stays_secs(self) -> Option<f32> {
        match self {
            Self::Problem(_) => None,
            Self::Confirmation => Some(CONFIRMATION_SECS),
            Self::Note | Self::FileWritten => Some(NOTE_SECS),
        }
    }
}

/// One message shown to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// Id by which it is dismissed.
    pub id: u64,
    /// Kind of notice.
    pub kind: NoticeKind,
    /// One sentence.
    pub text: String,
    /// The file it refers to, which can be shown in its folder.
    pub file: Option<PathBuf>,
    age_secs: f32,
}

/// All notices on screen.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Notices {
    list: Vec<Notice>,
    next_id: u64,
}

impl Notices {
    /// Adds a problem. A message that is already on screen is not repeated.
    pub fn problem(&mut self, about: NoticeTopic, text: impl Into<String>) {
        self.push(NoticeKind::Problem(about), text.into());
    }

    /// Adds a confirmation.
    pub fn confirm(&mut self, text: impl Into<String>) {
        self.push(NoticeKind::Confirmation, text.into());
    }

    /// Adds the confirmation that a file was written.
    pub fn file_written(&mut self, file: PathBuf) {
        self.push(NoticeKind::FileWritten, format!("Saved {}", file.display()));
        if let Some(notice) = self.list.last_mut() {
            notice.file = Some(file);
        }
    }

    /// Adds a note.
    pub fn note(&mut self, text: impl Into<String>) {
        self.push(NoticeKind::Note, text.into());
    }

    /// Whether there is a problem with this topic.
    #[must_use]
    pub fn has_problem(&self, about: NoticeTopic) -> bool {
        let kind = NoticeKind::Problem(about);
        self.list.iter().any(|notice| notice.kind == kind)
    }

    /// Marks the topic as resolved and removes its problems.
    pub fn resolve(&mut self, about: NoticeTopic) {
        let kind = NoticeKind::Problem(about);
        self.list.retain(|notice| notice.kind != kind);
    }

    /// All notices, oldest first.
    #[must_use]
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    /// Adds a notice, replacing an equal one.
    fn push(&mut self, kind: NoticeKind, text: String) {
        let text = SanitizedLine(text).to_string();
        // A repeated message becomes the newest: it moves to the end and its time restarts.
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

    /// Whether a notice will disappear by itself.
    #[must_use]
    pub fn has_expiring(&self) -> bool {
        self.list
            .iter()
            .any(|notice| notice.kind.stays_secs().is_some())
    }

    /// Ages all notices by `secs`; returns whether any disappeared.
    fn age(&mut self, secs: f32) -> bool {
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

/// Removes dismissed and expired notices. Nothing expires while the panels are hidden, because
/// nothing has been seen.
pub fn apply(
    mut intents: MessageReader<Intent>,
    time: Res<Time>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        if let Intent::DismissNotice(id) = intent {
            notices.list.retain(|notice| notice.id != *id);
        }
    }
    // Ageing is no visible change and must not trigger a redraw.
    let now = notices.bypass_change_detection();
    if preferences.panels && now.age(time.delta_secs()) {
        notices.set_changed();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_stay_until_resolved_and_confirmations_expire() {
        let mut notices = Notices::default();
        notices.problem(NoticeTopic::Saving, "lost");
        notices.problem(NoticeTopic::Film, "dark");
        notices.confirm("saved");
        assert!(notices.age(1e4) && !notices.age(1e4));
        assert_eq!(notices.list().len(), 2);
        notices.resolve(NoticeTopic::Film);
        assert_eq!(notices.list().len(), 1);
        assert_eq!(notices.list()[0].text, "lost");
        assert!(
            notices.has_problem(NoticeTopic::Saving) && !notices.has_problem(NoticeTopic::Film)
        );
    }

    #[test]
    fn a_repeated_message_is_shown_once() {
        let mut notices = Notices::default();
        notices.problem(NoticeTopic::Saving, "lost");
        notices.problem(NoticeTopic::Saving, "lost");
        assert_eq!(notices.list().len(), 1);
    }
}
