//! Notices shown to the user. Problems stay until they are dismissed or resolved; confirmations
//! disappear after some seconds.

use std::path::PathBuf;

use bevy::prelude::{DetectChangesMut, Local, MessageReader, Res, ResMut, Resource, Time};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::io::sanitize::SanitizedLine;

/// Seconds for which a confirmation stays (heuristic: long enough to read a file path).
const CONFIRMATION_SECS: f32 = 6.0;

/// Seconds for which notes and notices about written files stay; they take longer to read
/// (heuristic).
const NOTE_SECS: f32 = 10.0;

/// Topic of a problem; all problems of a topic disappear together when the topic is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeTopic {
    /// Opening files.
    Opening,
    /// Building the transition from the current settings.
    Transition,
    /// Saving the project.
    Saving,
    /// Autosave failure. The notice stays until autosave works again, because changes may be lost.
    Autosave,
    /// Autosaves in the fallback folder.
    AutosaveFolder,
    /// Damaged or unreadable autosave files.
    DamagedAutosave,
    /// A file name that the file dialog does not accept.
    FileName,
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
    /// Something succeeded; disappears after some seconds.
    Confirmation,
    /// A file was written; disappears after enough time to click the link to its folder.
    FileWritten,
    /// Information that the user may not expect; disappears after some seconds.
    Note,
}

impl NoticeTopic {
    /// Returns whether notices of this topic stay when another project is opened.
    fn outlives_project(self) -> bool {
        matches!(
            self,
            Self::Autosave | Self::AutosaveFolder | Self::DamagedAutosave
        )
    }
}

impl NoticeKind {
    /// Whether the user can dismiss notices of this kind.
    #[must_use]
    pub fn is_dismissible(self) -> bool {
        self != Self::Problem(NoticeTopic::Autosave)
    }

    /// Seconds for which a notice of this kind stays; `None` for problems, which do not expire.
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
    /// Id by which [`Intent::DismissNotice`] refers to the notice.
    pub id: u64,
    /// Kind of notice.
    pub kind: NoticeKind,
    /// Message to the user, one sentence.
    pub text: String,
    /// Written file that the notice reports and whose folder the user can open; `None` for other
    /// kinds.
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

    /// Whether a problem of this topic is on screen.
    #[must_use]
    pub fn has_problem(&self, about: NoticeTopic) -> bool {
        let kind = NoticeKind::Problem(about);
        self.list.iter().any(|notice| notice.kind == kind)
    }

    /// Removes all problems of a topic, because it is resolved.
    pub fn resolve(&mut self, about: NoticeTopic) {
        let kind = NoticeKind::Problem(about);
        self.list.retain(|notice| notice.kind != kind);
    }

    /// Removes the problems and notes of a project that is no longer open. Confirmations stay,
    /// because an action such as saving may just have been confirmed.
    pub fn leave_project(&mut self) {
        self.list.retain(|notice| match notice.kind {
            NoticeKind::Problem(topic) => topic.outlives_project(),
            NoticeKind::Note => false,
            NoticeKind::Confirmation | NoticeKind::FileWritten => true,
        });
    }

    /// Removes notices about written files that no longer exist; returns whether there were any.
    fn drop_missing_files(&mut self) -> bool {
        let before = self.list.len();
        let exists = |notice: &Notice| notice.file.as_ref().is_none_or(|file| file.exists());
        self.list.retain(exists);
        self.list.len() < before
    }

    /// All notices, oldest first.
    #[must_use]
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    /// Adds a notice as the newest; an older one with the same text is removed.
    fn push(&mut self, kind: NoticeKind, text: String) {
        let text = SanitizedLine(text).to_string();
        // A repeated message moves to the end and its time on screen restarts.
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

    /// Whether some notice will disappear by itself.
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

/// Seconds between two checks whether the files of notices still exist (resource limit: each check
/// reads the disk).
const FILE_CHECK_SECS: f32 = 1.0;

/// Removes dismissed and expired notices, and those about files that no longer exist. Nothing
/// expires while the panels are hidden, because the user cannot see the notices.
pub fn apply(
    mut intents: MessageReader<Intent>,
    time: Res<Time>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
    mut unchecked_secs: Local<f32>,
) {
    for intent in intents.read() {
        if let Intent::DismissNotice(id) = intent {
            let stays = |notice: &Notice| notice.id != *id || !notice.kind.is_dismissible();
            notices.list.retain(stays);
        }
    }
    // Ageing is no visible change and must not trigger a redraw.
    let now = notices.bypass_change_detection();
    let mut is_changed = preferences.panels && now.age(time.delta_secs());
    *unchecked_secs += time.delta_secs();
    if *unchecked_secs >= FILE_CHECK_SECS {
        *unchecked_secs = 0.0;
        is_changed |= now.drop_missing_files();
    }
    if is_changed {
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
    fn notices_about_deleted_files_disappear() {
        let folder = tempfile::tempdir().expect("a folder");
        let [kept, gone] = ["kept.gif", "gone.gif"].map(|name| folder.path().join(name));
        let mut notices = Notices::default();
        for file in [&kept, &gone] {
            std::fs::write(file, "").expect("a file");
            notices.file_written(file.clone());
        }
        assert!(!notices.drop_missing_files());
        std::fs::remove_file(&gone).expect("deleted");
        assert!(notices.drop_missing_files());
        assert_eq!(notices.list().len(), 1);
        assert_eq!(notices.list()[0].file.as_ref(), Some(&kept));
    }

    #[test]
    fn a_repeated_message_is_shown_once() {
        let mut notices = Notices::default();
        notices.problem(NoticeTopic::Saving, "lost");
        notices.problem(NoticeTopic::Saving, "lost");
        assert_eq!(notices.list().len(), 1);
    }
}
