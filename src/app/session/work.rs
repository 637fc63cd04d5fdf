//! The work on the next transition, beside the stage.

use std::time::{Duration, Instant};

use crate::app::session::loading::{LoadError, Loaded, Request};
use crate::app::session::open::Origin;
use crate::app::telling::job::{Broken, Job};

/// A build that takes longer is given up when the settings change again.
const PATIENCE: Duration = Duration::from_millis(1500);

/// What the work is for.
#[derive(Clone, Debug, PartialEq)]
pub enum WorkKind {
    /// Something else is being opened, from there.
    Open(Origin),
    /// What is open is being built with its new settings.
    Rebuild,
}

/// Why work came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum WorkError {
    /// Nothing could be opened.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// It broke off.
    #[error(transparent)]
    Broken(#[from] Broken),
}

/// Work that is going on.
#[derive(Debug)]
pub struct Work {
    /// What it is for.
    pub kind: WorkKind,
    job: Job<Result<Loaded, LoadError>>,
    started: Instant,
}

impl Work {
    /// Starts it.
    #[must_use]
    pub fn start(kind: WorkKind, request: Request) -> Self {
        let job = Job::start("the transition", move |progress| {
            request.carry_out(progress)
        });
        Self {
            kind,
            job,
            started: Instant::now(),
        }
    }

    /// What it is at, and how far, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> (&'static str, f64) {
        self.job.progress()
    }

    /// How long it has been going on.
    #[must_use]
    pub fn lasts(&self) -> Duration {
        self.started.elapsed()
    }

    /// It may be given up for newer settings.
    #[must_use]
    pub fn can_be_given_up(&self) -> bool {
        self.kind == WorkKind::Rebuild && self.lasts() > PATIENCE
    }

    /// What came of it, once, when it is done.
    #[must_use]
    pub fn poll(&self) -> Option<Result<Loaded, WorkError>> {
        let answer = self.job.poll()?;
        Some(answer.map_err(WorkError::from).and_then(|done| Ok(done?)))
    }
}
