//! Autosave: unsaved changes are written to the state folder within seconds, and offered for
//! recovery at the next start after a crash, kill or power failure.
//!
//! If the state folder is not writable, autosaves go to the folder for temporary files, and a notice
//! names it. If neither is writable, a notice stays until autosave works again.

use std::convert::Infallible;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use bevy::prelude::{DetectChanges, DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::input::intent::{Intent, RecoveryAnswer};
use crate::app::jobs::job::BackgroundJob;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::ScratchFolder;
use crate::app::persistence::autosave_slot::{AbandonedProject, AutosaveSlot};
use crate::app::session::load::LoadRequest;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::io::atomic_file::write_error_reason;
use crate::project::Project;

/// Minimum interval between two autosaves: with the time for writing, at most five seconds of work
/// are lost (heuristic).
const MIN_INTERVAL: Duration = Duration::from_secs(2);

/// Folders for autosaves, in order of preference.
#[must_use]
pub fn folders() -> Vec<PathBuf> {
    let state = dirs::state_dir().or_else(dirs::data_local_dir);
    let state = state.map(|state| state.join("morphospace").join("autosave"));
    state.into_iter().chain([temporary_folder()]).collect()
}

/// Folder of this user within the folder for temporary files, which all users share.
fn temporary_folder() -> PathBuf {
    #[cfg(unix)]
    let user = {
        use std::os::unix::fs::MetadataExt;
        let home = dirs::home_dir().and_then(|home| std::fs::metadata(home).ok());
        home.map_or_else(String::new, |home| format!("-{}", home.uid()))
    };
    #[cfg(not(unix))]
    let user = "";
    std::env::temp_dir().join(format!("morphospace{user}"))
}

/// A folder for autosaves and the slot that this window has locked there, if any.
#[derive(Debug)]
struct AutosaveFolder {
    folder: PathBuf,
    slot: Option<AutosaveSlot>,
}

/// State of autosave that is shown to the user.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum AutosaveStatus {
    /// Autosaves are written to the first place.
    #[default]
    Working,
    /// Autosaves are written to another folder; contains the text of the notice.
    Elsewhere(String),
    /// Nothing can be autosaved; contains the reason.
    Failing(String),
}

impl AutosaveStatus {
    /// Returns the status if the first folder failed for `reason`, and autosaves go to `used`.
    fn new(reason: Option<String>, used: Option<&Path>) -> Self {
        match (reason, used) {
            (None, _) => Self::Working,
            (Some(reason), Some(used)) => Self::Elsewhere(format!(
                "Cannot autosave to {reason}. Autosaves go to {} instead",
                used.display()
            )),
            (Some(reason), None) => Self::Failing(format!("cannot write to {reason}")),
        }
    }
}

/// The autosave of this window, and those that other windows left behind.
#[derive(Resource, Debug, Default)]
pub struct Autosave {
    /// Folders in order of preference. An autosave goes to the first one that is writable. Empty if
    /// autosave is off, as in tests.
    places: Vec<AutosaveFolder>,
    /// Slots of this window that the slot of a recovered project has replaced. They are stored here
    /// to keep them locked.
    former_slots: Vec<AutosaveSlot>,
    /// Slot of the project being recovered; it becomes the current slot once the project is open.
    opening_slot: Option<AutosaveSlot>,
    /// Autosaves left behind by windows that ended without saving.
    abandoned: Vec<AbandonedProject>,
    /// New paths of damaged autosaves that have not been reported.
    damaged_files: Vec<PathBuf>,
    /// Autosaves that cannot be read, with the reasons, and have not been reported.
    unreadable_files: Vec<String>,
    /// The project written last; `None` if writing it failed.
    written: Option<Project>,
    /// Time at which writing was last started.
    started_at: Option<Instant>,
    /// Whether the open project differs from the autosave.
    is_behind: bool,
    /// Whether the slots contain changes of the open project.
    has_own_changes: bool,
    /// Whether the changes in the slots have been saved or discarded, so that the slots can be
    /// cleared.
    is_resolved: bool,
    job: Option<BackgroundJob<AutosaveOutcome, Infallible>>,
    status: AutosaveStatus,
    /// Status that the notices show.
    reported: AutosaveStatus,
}

impl Autosave {
    /// Starts autosaving in the first of these folders that is writable. Also collects the autosaves
    /// in the other folders that exist.
    #[must_use]
    pub fn start_in(folders: &[impl AsRef<Path>]) -> Self {
        let mut autosave = Self::default();
        let mut reason = None;
        for folder in folders.iter().map(AsRef::as_ref) {
            let mut place = AutosaveFolder {
                folder: folder.to_owned(),
                slot: None,
            };
            let is_needed = autosave.used_folder().is_none();
            if is_needed || folder.exists() {
                match AutosaveSlot::lock_free_slot(folder) {
                    Ok(scan) => {
                        autosave.abandoned.extend(scan.abandoned);
                        autosave.damaged_files.extend(scan.damaged_files);
                        autosave.unreadable_files.extend(scan.unreadable_files);
                        match scan.free {
                            Ok(slot) => place.slot = Some(slot),
                            Err(error) if is_needed => {
                                reason.get_or_insert_with(|| write_failure(folder, &error));
                            }
                            Err(_) => {}
                        }
                    }
                    Err(error) if is_needed => {
                        reason.get_or_insert_with(|| write_failure(folder, &error));
                    }
                    Err(_) => {}
                }
            }
            autosave.places.push(place);
        }
        let abandoned = &mut autosave.abandoned;
        abandoned.sort_by_key(|abandoned| std::cmp::Reverse(abandoned.written_at));
        let used = autosave.used_folder().map(Path::to_owned);
        autosave.status = AutosaveStatus::new(reason, used.as_deref());
        autosave
    }

    /// The first folder in which this window has a slot.
    fn used_folder(&self) -> Option<&Path> {
        let mut places = self.places.iter();
        let used = places.find(|place| place.slot.is_some());
        used.map(|place| place.folder.as_path())
    }

    /// Scratch folder of this window for long-running exports.
    #[must_use]
    pub fn scratch_folder(&self) -> ScratchFolder {
        let mut slots = self.places.iter().filter_map(|place| place.slot.as_ref());
        ScratchFolder(slots.next().map(AutosaveSlot::scratch_folder))
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

    /// Whether changes are about to be autosaved. While autosave fails, writing is tried again at
    /// the usual redraws.
    #[must_use]
    pub fn is_behind(&self) -> bool {
        let is_failing = matches!(self.status, AutosaveStatus::Failing(_));
        (self.is_behind && !is_failing) || self.job.is_some()
    }
}

impl Drop for Autosave {
    /// Waits until the last autosave is written, then clears the slots if their changes have been
    /// saved or discarded.
    fn drop(&mut self) {
        let started = Instant::now();
        self.take_result();
        while self.job.is_some() && started.elapsed() < MIN_INTERVAL {
            std::thread::sleep(MIN_INTERVAL / 200);
            self.take_result();
        }
        self.clear_if_resolved();
    }
}

/// Reason why a folder or file cannot be used.
fn write_failure(path: &Path, error: &io::Error) -> String {
    let reason = write_error_reason(error);
    format!("{} ({reason})", path.display())
}

/// Result of writing an autosave.
#[derive(Debug, Default)]
struct AutosaveOutcome {
    /// Index of the folder that it was written to; `None` if all failed.
    place: Option<usize>,
    /// Slot that was locked there for the first time.
    locked: Option<AutosaveSlot>,
    /// New paths of damaged autosaves that were found.
    damaged_files: Vec<PathBuf>,
    /// Reason why the first folder failed; `None` if it was written to.
    reason: Option<String>,
}

impl AutosaveOutcome {
    /// Writes an autosave to the first folder that is writable. A folder comes with the path of the
    /// slot that is locked in it, if there is one.
    fn write(unsaved: &UnsavedProject, folders: &[(PathBuf, Option<PathBuf>)]) -> Self {
        let mut outcome = Self::default();
        for (index, (folder, path)) in folders.iter().enumerate() {
            let written = match path {
                Some(path) => unsaved.write(path).map(|()| None),
                None => outcome.write_to_new_slot(unsaved, folder).map(Some),
            };
            match written {
                Ok(locked) => {
                    (outcome.place, outcome.locked) = (Some(index), locked);
                    break;
                }
                Err(error) => {
                    let path = path.as_ref().unwrap_or(folder);
                    outcome
                        .reason
                        .get_or_insert_with(|| write_failure(path, &error));
                }
            }
        }
        outcome
    }

    /// Locks a free slot in a folder and writes an autosave to it. Autosaves that are found there
    /// are offered at the next start.
    fn write_to_new_slot(
        &mut self,
        unsaved: &UnsavedProject,
        folder: &Path,
    ) -> io::Result<AutosaveSlot> {
        let scan = AutosaveSlot::lock_free_slot(folder)?;
        self.damaged_files.extend(scan.damaged_files);
        let slot = scan.free?;
        unsaved.write(&slot.path)?;
        Ok(slot)
    }
}

/// Applies the user's answer to the offer to recover a project.
pub fn answer_recovery(
    mut intents: MessageReader<Intent>,
    mut autosave: ResMut<Autosave>,
    mut session: ResMut<Session>,
    question: Res<UnsavedQuestion>,
    conflict: Res<ConflictQuestion>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let answer = match intent {
            Intent::AnswerRecovery(answer) => *answer,
            // If another question is open above the offer to recover, Esc closes only that
            // question.
            Intent::Escape if question.text().is_none() && !conflict.is_open() => {
                RecoveryAnswer::Later
            }
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
    if autosave.places.is_empty() {
        return;
    }
    autosave.take_over_recovered_slot(&session);
    autosave.take_result();
    if session.is_changed() {
        if session.is_dirty() {
            autosave.is_behind = session.whole_project() != autosave.written.as_ref();
            (autosave.has_own_changes, autosave.is_resolved) = (true, false);
        } else {
            autosave.is_behind = false;
            // Only an autosave written for this project may be deleted.
            autosave.is_resolved = autosave.has_own_changes;
        }
    }
    autosave.is_behind &= session.is_dirty();
    autosave.clear_if_resolved();
    autosave.write_if_due(&session);
    autosave.report(&mut notices);
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
                let mut places = self.places.iter_mut();
                let place = places.find(|place| slot.path.starts_with(&place.folder));
                let former = place.and_then(|place| place.slot.replace(slot));
                self.former_slots.extend(former);
                (self.has_own_changes, self.is_resolved, self.written) = (true, false, None);
            }
        } else {
            self.opening_slot = None;
        }
    }

    /// Takes the result of writing an autosave, if it is finished. After a failure, writing is
    /// tried again later.
    fn take_result(&mut self) {
        let Some(result) = BackgroundJob::take_result(&mut self.job) else {
            return;
        };
        let result = result.unwrap_or_else(|error| AutosaveOutcome {
            reason: Some(error.to_string()),
            ..AutosaveOutcome::default()
        });
        self.damaged_files.extend(result.damaged_files);
        match result.place {
            Some(written) => {
                if let Some(slot) = result.locked {
                    self.places[written].slot = Some(slot);
                }
                // Autosaves in later folders are older. One in an earlier folder is kept, because
                // it also survives a power failure.
                let later = &self.places[written + 1..];
                let slots = later.iter().filter_map(|place| place.slot.as_ref());
                slots.for_each(AutosaveSlot::clear);
            }
            None => (self.written, self.is_behind) = (None, true),
        }
        let used = result
            .place
            .map(|index| self.places[index].folder.as_path());
        self.status = AutosaveStatus::new(result.reason, used);
    }

    /// Shows a changed status, and the autosaves that cannot be recovered.
    fn report(&mut self, notices: &mut Notices) {
        for path in self.damaged_files.drain(..) {
            let text = format!(
                "A damaged autosave cannot be recovered. It was renamed to {}",
                path.display()
            );
            notices.problem(NoticeTopic::DamagedAutosave, text);
        }
        for reason in self.unreadable_files.drain(..) {
            let text = format!("An autosave cannot be read: {reason}");
            notices.problem(NoticeTopic::DamagedAutosave, text);
        }
        if self.status == self.reported {
            return;
        }
        notices.resolve(NoticeTopic::AutosaveFolder);
        notices.resolve(NoticeTopic::Autosave);
        match &self.status {
            AutosaveStatus::Working => {}
            AutosaveStatus::Elsewhere(text) => notices.problem(NoticeTopic::AutosaveFolder, text),
            AutosaveStatus::Failing(reason) => {
                let text = format!("Autosave is failing: {reason}. Save the project regularly");
                notices.problem(NoticeTopic::Autosave, text);
            }
        }
        self.reported = self.status.clone();
    }

    /// Deletes the autosave once its changes are saved or discarded and nothing is being written.
    fn clear_if_resolved(&mut self) {
        if self.is_resolved && self.job.is_none() {
            let slots = self.places.iter().filter_map(|place| place.slot.as_ref());
            slots.for_each(AutosaveSlot::clear);
            (self.has_own_changes, self.is_resolved, self.written) = (false, false, None);
        }
    }

    /// Starts writing an autosave if there are changes to write and the last autosave is older than
    /// `MIN_INTERVAL`.
    fn write_if_due(&mut self, session: &Session) {
        let last = self.started_at.map(|when| when.elapsed());
        let is_due = last.is_none_or(|last| last >= MIN_INTERVAL) && self.job.is_none();
        if !(self.is_behind && is_due) {
            return;
        }
        self.started_at = Some(Instant::now());
        for place in &mut self.places {
            // A lock protects nothing once its file has been deleted or replaced.
            place.slot.take_if(|slot| slot.has_lost_lock());
        }
        match session.unsaved_project() {
            Some(Ok(unsaved)) => {
                let path = |slot: &AutosaveSlot| slot.path.clone();
                let places = self.places.iter();
                let places =
                    places.map(|place| (place.folder.clone(), place.slot.as_ref().map(path)));
                let places: Vec<_> = places.collect();
                self.job = Some(BackgroundJob::start("the autosave", move |_| {
                    Ok(AutosaveOutcome::write(&unsaved, &places))
                }));
                self.written = session.whole_project().cloned();
                self.is_behind = false;
            }
            Some(Err(error)) => self.status = AutosaveStatus::Failing(error.to_string()),
            None => self.is_behind = false,
        }
    }
}
