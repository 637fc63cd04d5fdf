//! Autosave: unsaved changes are written to the state folder within seconds, and offered for
//! recovery at the next start after a crash, kill or power failure.

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use bevy::prelude::{DetectChanges, DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::input::intent::{Intent, RecoveryAnswer};
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::ScratchFolder;
use crate::app::persistence::autosave_slot::{AbandonedProject, AutosaveSlot};
use crate::app::session::load::LoadRequest;
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::io::atomic_file::write_error_reason;
use crate::project::Project;

/// Minimum interval between two autosaves: with the time for writing, at most five seconds of work
/// are lost (heuristic).
const MIN_INTERVAL: Duration = Duration::from_secs(2);

/// Folder for autosaves; `None` if the system has no such folder.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let state = dirs::state_dir().or_else(dirs::data_local_dir);
    state.map(|state| state.join("morphospace").join("autosave"))
}

/// The autosave of this window, and those that other windows left behind.
#[derive(Resource, Debug, Default)]
pub struct Autosave {
    /// Current slot of this window; `None` switches autosave off, as in tests.
    slot: Option<AutosaveSlot>,
    /// Slot with which this window started; `None` while it is still the current slot. After a
    /// recovered project has been opened, the project's slot is the current one, and this one stays
    /// locked because it is stored here.
    initial_slot: Option<AutosaveSlot>,
    /// Slot of the project being recovered; it becomes the current slot once the project is open.
    opening_slot: Option<AutosaveSlot>,
    /// Autosaves left behind by windows that ended without saving.
    abandoned: Vec<AbandonedProject>,
    /// The project written last, and the time of writing.
    written: Option<(Project, Instant)>,
    /// Whether the open project differs from the autosave.
    is_behind: bool,
    /// Whether the slot contains changes of the open project.
    slot_is_ours: bool,
    /// Whether the changes in the slot have been saved or discarded, so that the slot can be
    /// cleared.
    is_resolved: bool,
    job: Option<BackgroundJob<(), io::Error>>,
    /// Whether a failed autosave has been reported; later failures are not reported.
    is_reported: bool,
}

impl Autosave {
    /// Starts autosaving in a folder.
    ///
    /// # Errors
    /// The folder cannot be created or written to.
    pub fn start_in(folder: &Path) -> io::Result<Self> {
        let (slot, abandoned) = AutosaveSlot::lock_free_slot(folder)?;
        let mut autosave = Self::default();
        (autosave.slot, autosave.abandoned) = (Some(slot), abandoned);
        Ok(autosave)
    }

    /// Scratch folder of this window for long-running exports.
    #[must_use]
    pub fn scratch_folder(&self) -> ScratchFolder {
        ScratchFolder(self.slot.as_ref().map(AutosaveSlot::scratch_folder))
    }

    /// The newest autosave to recover: its title and, if known, its age.
    #[must_use]
    pub fn recoverable(&self) -> Option<(&str, Option<Duration>)> {
        let abandoned = self.abandoned.first()?;
        let age = abandoned
            .written_at
            .and_then(|when| SystemTime::now().duration_since(when).ok());
        Some((&abandoned.project.title, age))
    }

    /// Whether changes are not autosaved yet.
    #[must_use]
    pub fn is_behind(&self) -> bool {
        self.is_behind || self.job.is_some()
    }
}

impl Drop for Autosave {
    /// Waits until the last autosave is written, then clears the slot if its changes have been
    /// saved or discarded.
    fn drop(&mut self) {
        let started = Instant::now();
        while self.job.is_some()
            && BackgroundJob::take_result(&mut self.job).is_none()
            && started.elapsed() < MIN_INTERVAL
        {
            std::thread::sleep(MIN_INTERVAL / 200);
        }
        self.clear_if_resolved();
    }
}

/// Applies the user's answer to the offer to recover a project.
pub fn answer_recovery(
    mut intents: MessageReader<Intent>,
    mut autosave: ResMut<Autosave>,
    mut session: ResMut<Session>,
    question: Res<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let answer = match intent {
            Intent::AnswerRecovery(answer) => *answer,
            // If another question is open above the offer to recover, Esc closes only that
            // question.
            Intent::Escape if question.text().is_none() => RecoveryAnswer::Later,
            _ => continue,
        };
        if autosave.abandoned.is_empty() {
            continue;
        }
        match answer {
            // All autosaves stay in their slots for the next start.
            RecoveryAnswer::Later => autosave.abandoned.clear(),
            RecoveryAnswer::Discard => autosave.abandoned.remove(0).slot.clear(),
            RecoveryAnswer::Restore if session.is_dirty() => {
                notices.confirm("Save or undo your changes first, then recover the project");
            }
            RecoveryAnswer::Restore => {
                let abandoned = autosave.abandoned.remove(0);
                session.open(LoadRequest::Recovered(Box::new(abandoned.project)));
                // Storing the slot keeps it locked: the autosave is still the only copy of these
                // changes.
                autosave.opening_slot = Some(abandoned.slot);
            }
        }
    }
}

/// Autosaves changes, and deletes the autosave once they have been saved or discarded.
pub fn follow(mut autosave: ResMut<Autosave>, session: Res<Session>, mut notices: ResMut<Notices>) {
    // No system reacts to changes of this resource, so none are reported.
    let autosave = autosave.bypass_change_detection();
    autosave.take_over_recovered_slot(&session);
    let Some(slot) = &autosave.slot else {
        return;
    };
    if let Some(Err(error)) = BackgroundJob::take_result(&mut autosave.job) {
        // Writing is tried again later.
        autosave.is_behind = session.is_dirty();
        if !std::mem::replace(&mut autosave.is_reported, true) {
            notices.problem(NoticeTopic::Saving, autosave_problem(&slot.path, &error));
        }
    }
    if session.is_changed() {
        let written = autosave.written.as_ref().map(|(project, _)| project);
        if session.is_dirty() {
            autosave.is_behind = session.whole_project() != written;
            (autosave.slot_is_ours, autosave.is_resolved) = (true, false);
        } else {
            autosave.is_behind = false;
            // Only an autosave written for this project may be deleted.
            autosave.is_resolved = autosave.slot_is_ours;
        }
    }
    autosave.clear_if_resolved();
    autosave.write_if_due(&session);
}

/// Text of the notice about a failed autosave.
fn autosave_problem(path: &Path, error: &JobError<io::Error>) -> String {
    let reason = match error {
        JobError::Failed(error) => write_error_reason(error),
        panicked => panicked.to_string(),
    };
    format!(
        "Cannot autosave to {} ({reason}). Save the project regularly",
        path.display()
    )
}

impl Autosave {
    /// Takes over the slot of a recovered project, so that its autosave stays until the project is
    /// saved. If the project could not be opened, the autosave stays in its slot for the next
    /// start.
    fn take_over_recovered_slot(&mut self, session: &Session) {
        if session.is_opening() {
            // It is still unknown whether the recovered project can be opened.
        } else if session.is_recovered() {
            if let Some(slot) = self.opening_slot.take() {
                let previous = self.slot.replace(slot);
                self.initial_slot = self.initial_slot.take().or(previous);
                (self.slot_is_ours, self.is_resolved, self.written) = (true, false, None);
            }
        } else {
            self.opening_slot = None;
        }
    }

    /// Deletes the autosave once its changes are saved or discarded and nothing is being written.
    fn clear_if_resolved(&mut self) {
        if self.is_resolved && self.job.is_none() {
            self.slot.iter().for_each(AutosaveSlot::clear);
            (self.slot_is_ours, self.is_resolved, self.written) = (false, false, None);
        }
    }

    /// Starts writing an autosave if there are changes to write and the last autosave is older than
    /// `MIN_INTERVAL`.
    fn write_if_due(&mut self, session: &Session) {
        let last = self.written.as_ref().map(|(_, when)| when.elapsed());
        let is_due = last.is_none_or(|last| last >= MIN_INTERVAL) && self.job.is_none();
        if !(self.is_behind && is_due) {
            return;
        }
        let unsaved = session.unsaved_project().and_then(Result::ok);
        let project = session.whole_project();
        if let (Some(slot), Some(unsaved), Some(project)) = (&self.slot, unsaved, project) {
            let path = slot.path.clone();
            self.job = Some(BackgroundJob::start("the autosave", move |_| {
                unsaved.write(&path)
            }));
            self.written = Some((project.clone(), Instant::now()));
        }
        self.is_behind = false;
    }
}
