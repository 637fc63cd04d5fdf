//! The work on the next transition, beside the stage.

use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::app::jobs::job;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::document::OpenDocument;
use crate::app::session::load::{BuiltProject, InterimResult, LoadError, LoadRequest, needs_build};
use crate::app::session::origin::ProjectOrigin;
use crate::project::Project;

/// A build that takes longer is given up when the settings change again. Shorter, and a build that
/// takes a second would never be seen while a slider moves; longer, and the slider seems stuck.
const PATIENCE: Duration = Duration::from_millis(1500);

/// What is opened is shown by the plainest method when it takes longer than this: sooner, and each
/// project would be seen twice; later, and a stage stays empty that need not.
const PLAIN_AFTER: Duration = Duration::from_millis(1000);

/// A draft of what is open is shown when what it is a draft of takes longer than this: sooner, and
/// while a pin is dragged each place of it would be seen twice. Of what is being opened it is shown
/// at once.
const DRAFT_AFTER: Duration = Duration::from_millis(300);

impl InterimResult {
    fn is_shown_after(&self, is_opening: bool) -> Duration {
        match self {
            Self::Plain(_) => PLAIN_AFTER,
            Self::Draft(_) if is_opening => Duration::ZERO,
            Self::Draft(_) => DRAFT_AFTER,
        }
    }
}

/// Work that is going on.
#[derive(Debug)]
pub struct TransitionWork {
    /// Where what is being opened comes from; none where what is open is being built with its new
    /// settings.
    pub origin: Option<ProjectOrigin>,
    /// The settings that it builds, as far as they are known.
    pub wanted: Option<Project>,
    /// The work.
    pub job: BackgroundJob<BuiltProject, LoadError>,
    /// What it opens has changes that no file has.
    pub is_unsaved: bool,
    /// A draft of it is on the stage.
    pub has_draft: bool,
    /// What can be shown before it is done, and the last that was not shown yet.
    meanwhile: Mutex<Receiver<InterimResult>>,
    waiting: Option<InterimResult>,
}

impl TransitionWork {
    /// Starts it.
    #[must_use]
    pub fn start(request: LoadRequest) -> Self {
        let (sender, receiver) = channel();
        Self {
            origin: request.origin(),
            wanted: request.settings().cloned(),
            is_unsaved: matches!(request, LoadRequest::Rescued(_)),
            job: BackgroundJob::start("the transition", move |progress| {
                // Nobody listens any more once the work was given up.
                request.carry_out(progress, |meanwhile| {
                    drop(sender.send(meanwhile));
                    job::wake();
                })
            }),
            has_draft: false,
            meanwhile: Mutex::new(receiver),
            waiting: None,
        }
    }

    /// How what it opens is taken in.
    #[must_use]
    pub fn opened(&self) -> fn(BuiltProject, ProjectOrigin) -> OpenDocument {
        if self.is_unsaved {
            OpenDocument::unsaved
        } else {
            OpenDocument::new
        }
    }

    /// It may be given up for newer settings.
    #[must_use]
    pub fn can_be_given_up(&self) -> bool {
        self.origin.is_none() && self.job.lasts() > PATIENCE
    }

    /// It builds something else than these settings.
    #[must_use]
    pub fn is_not_of(&self, project: &Project) -> bool {
        let wanted = self.wanted.as_ref();
        wanted.is_none_or(|wanted| needs_build(wanted, project))
    }

    /// What can be shown before it is done, once that is worth showing. What is being opened comes
    /// with where it is from: from then on it is open, and the work builds it with the settings
    /// that it asks for.
    pub fn take_meanwhile(&mut self) -> Option<(BuiltProject, Option<ProjectOrigin>)> {
        let receiver = self.meanwhile.get_mut();
        let receiver = receiver.unwrap_or_else(PoisonError::into_inner);
        // Of two the last: a draft is better than what moves nothing.
        self.waiting = receiver.try_iter().last().or(self.waiting.take());
        let lasts = self.job.lasts();
        let is_opening = self.origin.is_some();
        let is_due = |m: &mut InterimResult| lasts >= m.is_shown_after(is_opening);
        let shown = self.waiting.take_if(is_due)?;
        self.has_draft |= matches!(shown, InterimResult::Draft(_));
        let (InterimResult::Plain(loaded) | InterimResult::Draft(loaded)) = shown;
        self.wanted = Some(loaded.project.project.clone());
        Some((loaded, self.origin.take()))
    }
}
