//! Changes that are not saved are kept in the state folder some seconds after they were made, and
//! offered at the next start where the program ended without asking: killed, crashed, out of power.

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
use crate::io::atomic_file::reason;
use crate::project::Project;

/// The shortest time between two writes: with what a write takes, no more than five seconds of
/// work are lost.
const EVERY: Duration = Duration::from_secs(2);

/// The folder for what is kept; none where nothing is to be kept, as in tests.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let state = dirs::state_dir().or_else(dirs::data_local_dir);
    state.map(|state| state.join("morphospace").join("autosave"))
}

/// What is kept of the open project, and what others have left.
#[derive(Resource, Debug, Default)]
pub struct Autosave {
    slot: Option<AutosaveSlot>,
    /// That of this window from the beginning, where it has taken up another since.
    first: Option<AutosaveSlot>,
    /// That of what is being taken up; it becomes this window's once it is open.
    opening: Option<AutosaveSlot>,
    lost: Vec<AbandonedProject>,
    /// What was written last, and when.
    written: Option<(Project, Instant)>,
    /// The open project is another than what was written.
    is_behind: bool,
    /// What lies in its place is of the open project.
    is_own: bool,
    /// It is of changes that are saved, or given up.
    is_over: bool,
    job: Option<BackgroundJob<(), io::Error>>,
    is_told: bool,
}

impl Autosave {
    /// Keeps changes in that folder.
    ///
    /// # Errors
    /// It cannot be made or written to.
    pub fn enter(folder: &Path) -> io::Result<Self> {
        let (slot, lost) = AutosaveSlot::enter(folder)?;
        let mut entered = Self::default();
        (entered.slot, entered.lost) = (Some(slot), lost);
        Ok(entered)
    }

    /// Where this window makes what takes long.
    #[must_use]
    pub fn workshop(&self) -> ScratchFolder {
        ScratchFolder(self.slot.as_ref().map(AutosaveSlot::workshop))
    }

    /// What can be taken up again: its title, and how long ago it was kept.
    #[must_use]
    pub fn lost(&self) -> Option<(&str, Option<Duration>)> {
        let lost = self.lost.first()?;
        let age = lost
            .when
            .and_then(|when| SystemTime::now().duration_since(when).ok());
        Some((&lost.kept.title, age))
    }

    /// Something is not kept yet.
    #[must_use]
    pub fn is_behind(&self) -> bool {
        self.is_behind || self.job.is_some()
    }
}

impl Drop for Autosave {
    /// What is being written may be of changes that are saved, or were given up, by now.
    fn drop(&mut self) {
        let began = Instant::now();
        while self.job.is_some()
            && BackgroundJob::take(&mut self.job).is_none()
            && began.elapsed() < EVERY
        {
            std::thread::sleep(EVERY / 200);
        }
        self.clear_where_over();
    }
}

/// Acts on the answer to what can be taken up again.
pub fn rescue(
    mut intents: MessageReader<Intent>,
    (mut autosave, mut session): (ResMut<Autosave>, ResMut<Session>),
    question: Res<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let answer = match intent {
            Intent::Rescue(answer) => *answer,
            // Another question lies above this one.
            Intent::Back if question.text().is_none() => RecoveryAnswer::Later,
            _ => continue,
        };
        if autosave.lost.is_empty() {
            continue;
        }
        match answer {
            // Left where it is for the next start.
            RecoveryAnswer::Later => autosave.lost.clear(),
            RecoveryAnswer::Discard => autosave.lost.remove(0).slot.clear(),
            RecoveryAnswer::Restore if session.is_dirty() => {
                notices.done("Save or undo your changes first: then it can be restored.");
            }
            RecoveryAnswer::Restore => {
                let lost = autosave.lost.remove(0);
                session.open(LoadRequest::Rescued(Box::new(lost.kept)));
                autosave.opening = Some(lost.slot);
            }
        }
    }
}

/// Keeps what has changed, and forgets what was saved.
pub fn follow(mut autosave: ResMut<Autosave>, session: Res<Session>, mut notices: ResMut<Notices>) {
    // Looked at in each frame; nobody asks whether it has changed.
    let autosave = autosave.bypass_change_detection();
    autosave.take_up(&session);
    let Some(slot) = &autosave.slot else {
        return;
    };
    if let Some(Err(error)) = BackgroundJob::take(&mut autosave.job) {
        // Tried again after a while.
        autosave.is_behind = session.is_dirty();
        if !std::mem::replace(&mut autosave.is_told, true) {
            notices.problem(NoticeTopic::Saving, cannot_keep(&slot.path, &error));
        }
    }
    if session.is_changed() {
        let written = autosave.written.as_ref().map(|(project, _)| project);
        if session.is_dirty() {
            autosave.is_behind = session.whole() != written;
            (autosave.is_own, autosave.is_over) = (true, false);
        } else {
            autosave.is_behind = false;
            autosave.is_over = autosave.is_own;
        }
    }
    autosave.clear_where_over();
    autosave.write_where_due(&session);
}

fn cannot_keep(path: &Path, error: &JobError<io::Error>) -> String {
    let reason = match error {
        JobError::Failed(error) => reason(error),
        broken => broken.to_string(),
    };
    format!(
        "Changes cannot be kept in {} ({reason}): save the project now and then.",
        path.display()
    )
}

impl Autosave {
    /// What is taken up stays in its place until it is saved; where it could not be opened, until
    /// the next start.
    fn take_up(&mut self, session: &Session) {
        if session.is_opening() {
            // It is not known yet whether it can be.
        } else if session.is_rescued() {
            if let Some(slot) = self.opening.take() {
                let own = self.slot.replace(slot);
                self.first = self.first.take().or(own);
                (self.is_own, self.is_over, self.written) = (true, false, None);
            }
        } else {
            self.opening = None;
        }
    }

    fn clear_where_over(&mut self) {
        if self.is_over && self.job.is_none() {
            self.slot.iter().for_each(AutosaveSlot::clear);
            (self.is_own, self.is_over, self.written) = (false, false, None);
        }
    }

    fn write_where_due(&mut self, session: &Session) {
        let last = self.written.as_ref().map(|(_, when)| when.elapsed());
        let is_due = last.is_none_or(|last| last >= EVERY) && self.job.is_none();
        if !(self.is_behind && is_due) {
            return;
        }
        let kept = session.kept().and_then(Result::ok);
        if let (Some(slot), Some(kept), Some(project)) = (&self.slot, kept, session.whole()) {
            let path = slot.path.clone();
            self.job = Some(BackgroundJob::start("an autosave", move |_| {
                kept.write(&path)
            }));
            self.written = Some((project.clone(), Instant::now()));
        }
        self.is_behind = false;
    }
}
