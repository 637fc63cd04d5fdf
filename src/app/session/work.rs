//! The work on the next transition, beside the stage.

use std::time::Duration;

use crate::app::session::loading::{LoadError, Loaded, Origin, Request};
use crate::app::telling::job::Job;

/// A build that takes longer is given up when the settings change again. Shorter, and a build that
/// takes a second would never be seen while a slider moves; longer, and the slider seems stuck.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Work that is going on.
#[derive(Debug)]
pub struct Work {
    /// Where what is being opened comes from; none where what is open is being built with its new
    /// settings.
    pub origin: Option<Origin>,
    /// The work.
    pub job: Job<Loaded, LoadError>,
}

impl Work {
    /// Starts it.
    #[must_use]
    pub fn start(request: Request) -> Self {
        Self {
            origin: request.origin(),
            job: Job::start("the transition", |progress| request.carry_out(progress)),
        }
    }

    /// It may be given up for newer settings.
    #[must_use]
    pub fn can_be_given_up(&self) -> bool {
        self.origin.is_none() && self.job.lasts() > PATIENCE
    }
}
