//! The work on the next transition, beside the stage.

use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::app::session::loading::{LoadError, Loaded, Origin, Request, needs_build};
use crate::app::telling::job::Job;
use crate::project::Project;

/// A build that takes longer is given up when the settings change again. Shorter, and a build that
/// takes a second would never be seen while a slider moves; longer, and the slider seems stuck.
const PATIENCE: Duration = Duration::from_millis(1500);

/// What is opened is shown by the plainest method when it takes longer than this: sooner, and each
/// project would be seen twice; later, and a stage stays empty that need not.
const MEANWHILE: Duration = Duration::from_millis(1000);

/// Work that is going on.
#[derive(Debug)]
pub struct Work {
    /// Where what is being opened comes from; none where what is open is being built with its new
    /// settings.
    pub origin: Option<Origin>,
    /// The settings that it builds, as far as they are known.
    pub wanted: Option<Project>,
    /// The work.
    pub job: Job<Loaded, LoadError>,
    /// What can be shown before it is done.
    meanwhile: Mutex<Receiver<Loaded>>,
}

impl Work {
    /// Starts it.
    #[must_use]
    pub fn start(request: Request) -> Self {
        let (sender, receiver) = channel();
        Self {
            origin: request.origin(),
            wanted: request.settings().cloned(),
            job: Job::start("the transition", move |progress| {
                // Nobody listens any more once the work was given up.
                request.carry_out(progress, |loaded| drop(sender.send(loaded)))
            }),
            meanwhile: Mutex::new(receiver),
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

    /// What is being opened, by the plainest method, once that is worth showing. From then on it
    /// is open, and the work builds it with the settings that it asks for.
    pub fn take_meanwhile(&mut self) -> Option<(Loaded, Origin)> {
        if self.origin.is_none() || self.job.lasts() < MEANWHILE {
            return None;
        }
        let receiver = self.meanwhile.get_mut();
        let receiver = receiver.unwrap_or_else(PoisonError::into_inner);
        let loaded = receiver.try_recv().ok()?;
        self.wanted = Some(loaded.project.project.clone());
        Some((loaded, self.origin.take()?))
    }
}
