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

/// A rebuild older than this is abandoned when the settings change again. Shorter, and builds of a
/// second would never appear while a slider moves; longer, and the slider seems stuck (heuristic).
const ABANDON_AFTER: Duration = Duration::from_millis(1500);

/// A project being opened is shown by the plainest method after this time. Sooner, and every
/// project would appear twice; later, and the stage stays empty needlessly (heuristic).
const PLAIN_AFTER: Duration = Duration::from_millis(1000);

/// During a rebuild, a draft is shown after this time. Sooner, and every position of a dragged pin
/// would appear twice. While opening, a draft is shown at once (heuristic).
const DRAFT_AFTER: Duration = Duration::from_millis(300);

impl InterimResult {
    /// Age of the work from which this result is shown.
    fn is_shown_after(&self, is_opening: bool) -> Duration {
        match self {
            Self::Plain(_) => PLAIN_AFTER,
            Self::Draft(_) if is_opening => Duration::ZERO,
            Self::Draft(_) => DRAFT_AFTER,
        }
    }
}

/// Work in progress.
#[derive(Debug)]
pub struct TransitionWork {
    /// Origin of the project being opened; `None` for a rebuild of the open one.
    pub origin: Option<ProjectOrigin>,
    /// Settings being built, as far as they are known.
    pub settings: Option<Project>,
    /// The background job.
    pub job: BackgroundJob<BuiltProject, LoadError>,
    /// Whether the project being opened has unsaved changes.
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

    /// Constructor that turns the result into an open project.
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

    /// Whether the work builds something else than these settings ask for.
    #[must_use]
    pub fn builds_other_than(&self, project: &Project) -> bool {
        let settings = self.settings.as_ref();
        settings.is_none_or(|settings| needs_build(settings, project))
    }

    /// Interim result that is due to be shown. The first one of a project being opened comes with
    /// its origin: from then on the project is open, and the work counts as its rebuild.
    pub fn take_interim(&mut self) -> Option<(BuiltProject, Option<ProjectOrigin>)> {
        let receiver = self.interim_results.get_mut();
        let receiver = receiver.unwrap_or_else(PoisonError::into_inner);
        // Only the latest: a draft is better than the plainest method.
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
