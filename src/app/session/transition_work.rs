//! Background work on the next transition: one job that opens or rebuilds a project, and the
//! interim results it sends.

use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::app::jobs::job;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::document::OpenDocument;
use crate::app::session::load::{BuiltProject, InterimResult, LoadError, LoadRequest, needs_build};
use crate::app::session::origin::ProjectOrigin;
use crate::project::Project;

/// Time after which a running rebuild is abandoned when the settings change again. If it were
/// shorter, builds that take a second would never appear while a slider moves; if longer, the
/// slider would seem stuck (heuristic).
const ABANDON_AFTER: Duration = Duration::from_millis(1500);

/// Time after which a project being opened is shown by the plainest method, a blend without a warp.
/// If it were shorter, every project would appear twice; if longer, the stage would stay empty
/// needlessly (heuristic).
const PLAIN_AFTER: Duration = Duration::from_millis(1000);

/// Time after which a draft is shown during a rebuild. If it were shorter, every position of a
/// dragged pin would appear twice. While opening, a draft is shown at once (heuristic).
const DRAFT_AFTER: Duration = Duration::from_millis(300);

impl InterimResult {
    /// Time since the start of the work after which this interim result may be shown.
    fn is_shown_after(&self, is_opening: bool) -> Duration {
        match self {
            Self::Plain(_) => PLAIN_AFTER,
            Self::Draft(_) if is_opening => Duration::ZERO,
            Self::Draft(_) => DRAFT_AFTER,
        }
    }
}

/// Running job that opens or rebuilds a project.
#[derive(Debug)]
pub struct TransitionWork {
    /// Origin of the project being opened; `None` for a rebuild of the open one.
    pub origin: Option<ProjectOrigin>,
    /// Settings being built; `None` until the project being opened has been read.
    pub settings: Option<Project>,
    /// The background job.
    pub job: BackgroundJob<BuiltProject, LoadError>,
    /// Whether the project being opened is recovered from an autosave, so that it counts as
    /// unsaved.
    pub is_unsaved: bool,
    /// Whether a draft of the result is on the stage.
    pub has_draft: bool,
    /// Channel for interim results.
    interim_results: Mutex<Receiver<InterimResult>>,
    /// Latest interim result not shown yet.
    pending_interim: Option<InterimResult>,
}

impl TransitionWork {
    /// Starts the work.
    #[must_use]
    pub fn start(request: LoadRequest) -> Self {
        let (sender, receiver) = channel();
        Self {
            origin: request.origin(),
            settings: request.settings().cloned(),
            is_unsaved: matches!(request, LoadRequest::Recovered(_)),
            job: BackgroundJob::start("the transition", move |progress| {
                // Sending fails once the work has been abandoned.
                request.carry_out(progress, |interim| {
                    drop(sender.send(interim));
                    job::wake();
                })
            }),
            has_draft: false,
            interim_results: Mutex::new(receiver),
            pending_interim: None,
        }
    }

    /// Constructor that turns the result of opening into an open project.
    #[must_use]
    pub fn document_constructor(&self) -> fn(BuiltProject, ProjectOrigin) -> OpenDocument {
        if self.is_unsaved {
            OpenDocument::unsaved
        } else {
            OpenDocument::new
        }
    }

    /// Whether the work may be abandoned for newer settings.
    #[must_use]
    pub fn can_be_abandoned(&self) -> bool {
        self.origin.is_none() && self.job.elapsed() > ABANDON_AFTER
    }

    /// Whether the work builds a transition for other settings than those of `project`; true while
    /// its settings are unknown.
    #[must_use]
    pub fn builds_other_than(&self, project: &Project) -> bool {
        let settings = self.settings.as_ref();
        settings.is_none_or(|settings| needs_build(settings, project))
    }

    /// Takes the interim result that is due to be shown. If a project is being opened, its first
    /// interim result is returned with the project's origin: from then on the project is open, and
    /// the work counts as its rebuild.
    pub fn take_interim(&mut self) -> Option<(BuiltProject, Option<ProjectOrigin>)> {
        let receiver = self.interim_results.get_mut();
        let receiver = receiver.unwrap_or_else(PoisonError::into_inner);
        // Only the latest result matters: a draft is better than the plainest method.
        self.pending_interim = receiver.try_iter().last().or(self.pending_interim.take());
        let elapsed = self.job.elapsed();
        let is_opening = self.origin.is_some();
        let is_due = |result: &mut InterimResult| elapsed >= result.is_shown_after(is_opening);
        let interim = self.pending_interim.take_if(is_due)?;
        self.has_draft |= matches!(interim, InterimResult::Draft(_));
        let (InterimResult::Plain(loaded) | InterimResult::Draft(loaded)) = interim;
        // The settings are known only now that the project has been read.
        self.settings = Some(loaded.project.project.clone());
        Some((loaded, self.origin.take()))
    }
}
