//! Background work of the session: starting a build, showing its progress, and putting its results
//! on the stage.

use std::time::Duration;

use super::Session;
use crate::app::jobs::job::JobError;
use crate::app::session::document::OpenDocument;
use crate::app::session::load;
use crate::app::session::load::{LoadError, LoadRequest};
use crate::app::session::transition_work::TransitionWork;

/// Time after which a build is shown to the user as work in progress. While a slider or pin is
/// dragged, one short build follows another, and none of them is shown (heuristic).
const SHOWN_AFTER: Duration = Duration::from_millis(300);

/// Progress text while a draft can already be played.
const IMPROVING_FILM: &str = "Improving film";

/// Result of [`Session::poll`].
#[derive(Debug)]
pub enum WorkOutcome {
    /// Another project is open; if it has no transition, [`Session::problem`] gives the reason.
    Opened,
    /// The open project has a new transition.
    Rebuilt,
    /// No transition can be built from the new settings, and the old one stays;
    /// [`Session::problem`] gives the reason.
    RebuildFailed,
    /// A project or design cannot be read, or the job failed for another reason.
    Failed(JobError<LoadError>),
}

/// Background work on the next transition.
impl Session {
    /// Name of the current step of the background work, and the progress of the whole work, from 0
    /// to 1; `None` if no work is running.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.work.as_ref().map(|work| work.job.progress())
    }

    /// Text and progress, in [0, 1], of the background work to show to the user; `None` until the
    /// work has taken long enough to be shown.
    #[must_use]
    pub fn visible_work(&self) -> Option<(&'static str, f64)> {
        let work = self.work.as_ref()?;
        let (stage, fraction) = work.job.progress();
        let stage = if work.has_draft {
            IMPROVING_FILM
        } else {
            stage
        };
        (work.job.elapsed() > SHOWN_AFTER).then_some((stage, fraction))
    }

    /// Builds a transition that was refused because it would take too long or too much memory, and
    /// lifts both limits for this project from now on.
    pub fn build_anyway(&mut self) {
        if let Some(open) = &mut self.open {
            open.loaded.patient = true;
            open.request_refused();
            // The build is tried again and reports its problems anew.
            open.clear_problems();
            self.is_stale = true;
        }
    }

    /// Requests that the designs of the open project are read again.
    pub fn reread(&mut self) {
        if let Some(open) = &mut self.open {
            open.must_reread = true;
            self.is_stale = true;
        }
    }

    /// Closes the open project, and cancels opening another one.
    pub fn close(&mut self) {
        (self.open, self.work, self.is_stale) = (None, None, false);
    }

    /// Opens another project in the background.
    pub fn open(&mut self, request: LoadRequest) {
        self.is_stale = false;
        self.work = Some(TransitionWork::start(request));
    }

    /// Cancels the background work and resets the settings to those that the stage was built from.
    pub fn cancel(&mut self) {
        // Dropping the job cancels it; there is no need to wait for its end.
        let Some(work) = self.work.take() else {
            return;
        };
        self.is_stale = false;
        if let (None, Some(open)) = (work.origin, &mut self.open) {
            open.reset_settings();
        }
    }

    /// Adopts the result of finished work and starts the next work. A better film replaces a draft
    /// on the stage only if `may_change`, which is true at times when the swap is not visible.
    pub fn poll(&mut self, may_change: bool) -> Option<WorkOutcome> {
        let must_wait = |work: &TransitionWork| work.has_draft && !may_change;
        let outcome = match &self.work {
            Some(work) if must_wait(work) => None,
            _ => self.adopt_result().or_else(|| self.adopt_interim()),
        };
        if outcome.is_some() {
            self.adopt_playing_method();
        }
        // While a slider is dragged, a short build is completed, so that intermediate results
        // appear; a long one is abandoned.
        let can_start = self
            .work
            .as_ref()
            .is_none_or(TransitionWork::can_be_abandoned);
        if self.is_stale
            && can_start
            && let Some(open) = &self.open
        {
            self.is_stale = false;
            self.work = Some(TransitionWork::start(LoadRequest::Rebuild(Box::new(
                open.rebuild(),
            ))));
        }
        outcome
    }

    /// Requests the method that plays if the requested one could not be built, so that the panels
    /// and the saved project name the method that is seen.
    fn adopt_playing_method(&mut self) {
        let is_adopted = self
            .open
            .as_mut()
            .is_some_and(OpenDocument::adopt_playing_method);
        // If only some segments could not be built, the others must be built again.
        if is_adopted && let Some(open) = &self.open {
            self.is_stale |= load::needs_build(&open.staged, &open.loaded.project);
        }
    }

    /// Puts an interim result on the stage if one is due.
    fn adopt_interim(&mut self) -> Option<WorkOutcome> {
        let work = self.work.as_mut()?;
        let opened = work.document_constructor();
        let (loaded, origin) = work.take_interim()?;
        match (origin, &mut self.open) {
            // The first interim result of a project being opened: this project replaces the open
            // one.
            (Some(origin), open) => {
                self.is_stale = false;
                self.opened_count += 1;
                *open = Some(opened(loaded, origin));
                Some(WorkOutcome::Opened)
            }
            (None, Some(open)) => open.restage(loaded).then_some(WorkOutcome::Rebuilt),
            (None, None) => None,
        }
    }

    /// Puts the result of finished work on the stage.
    fn adopt_result(&mut self) -> Option<WorkOutcome> {
        let result = self.work.as_ref()?.job.poll()?;
        let work = self.work.take()?;
        let (opened, origin) = (work.document_constructor(), work.origin);
        Some(match (result, origin, &mut self.open) {
            (Ok(loaded), Some(origin), open) => {
                self.is_stale = false;
                self.opened_count += 1;
                *open = Some(opened(loaded, origin));
                WorkOutcome::Opened
            }
            (Ok(built), None, Some(open)) => {
                if open.restage(built) {
                    WorkOutcome::Rebuilt
                } else {
                    WorkOutcome::RebuildFailed
                }
            }
            // Unreachable in practice: closing the project ends its work.
            (Ok(_), None, None) => return None,
            (Err(error), origin, open) => {
                if let (None, Some(open)) = (origin, open) {
                    // A file that cannot be read would make every later build fail.
                    open.reset_designs();
                }
                WorkOutcome::Failed(error)
            }
        })
    }
}
