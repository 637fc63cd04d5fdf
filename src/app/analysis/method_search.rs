//! Method search: tries all methods that suit the designs in the background and uses the one whose
//! film has the fewest defects.

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::state::Session;
use crate::measure::{FilmRating, auto};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::TransitionMethod;
use crate::work::progress::{Progress, WholeProgress};

/// The chosen method and the rating of its film; pictures have no rating.
type MethodChoice = (TransitionMethod, Option<FilmRating>);

/// The method search, while it runs.
#[derive(Resource, Debug, Default)]
pub struct MethodSearch(Option<MethodSearchJob>);

/// A running search.
#[derive(Debug)]
struct MethodSearchJob {
    /// Settings for which the search was started.
    of: Project,
    job: BackgroundJob<MethodChoice, ProjectError>,
}

impl MethodSearch {
    /// Progress of the search, 0 to 1; `None` if none runs.
    #[must_use]
    pub fn told(&self) -> Option<f64> {
        Some(self.0.as_ref()?.job.progress().1)
    }

    /// Cancels the search and keeps the current method.
    pub fn stop(&mut self) {
        // Dropping the job cancels it.
        self.0 = None;
    }

    /// Starts a search for the current segment.
    fn start(&mut self, session: &Session) {
        let Some(staged) = session.staged() else {
            return;
        };
        let of = staged.project.clone();
        let job = BackgroundJob::start("the method search", move |progress| {
            search(&staged, progress)
        });
        self.0 = Some(MethodSearchJob { of, job });
    }

    /// Result of a finished search, returned once. A search for designs or options that have
    /// changed since is dropped.
    fn take(&mut self, session: &Session) -> Option<Result<MethodChoice, JobError<ProjectError>>> {
        let trial = self.0.as_ref()?;
        let is_same =
            |now: &Project| (&now.designs, &now.options) == (&trial.of.designs, &trial.of.options);
        if !session.project().is_some_and(is_same) {
            self.0 = None;
            return None;
        }
        let answer = trial.job.poll()?;
        self.0 = None;
        Some(answer)
    }
}

/// Builds and rates the suitable methods; returns the best one.
fn search(loaded: &LoadedProject, progress: &dyn Progress) -> Result<MethodChoice, ProjectError> {
    let progress = &WholeProgress::new(progress);
    let (transition, rating) = auto(&loaded.spec()?, progress)?;
    Ok((transition.cell(), rating))
}

/// Starts or cancels a search on request, and applies the method it found.
pub fn apply(
    mut intents: MessageReader<Intent>,
    (mut session, mut method_search): (ResMut<Session>, ResMut<MethodSearch>),
    (mut notices, gesture): (ResMut<Notices>, Res<Gesture>),
) {
    // Change detection is set by hand: this system runs each frame but seldom changes anything.
    let trial = method_search.bypass_change_detection();
    let was_busy = trial.told().is_some();
    for intent in intents.read() {
        match intent {
            Intent::ChooseMethod => trial.start(&session),
            Intent::CancelChoice => trial.stop(),
            _ => {}
        }
    }
    match trial.take(&session) {
        Some(Ok((cell, rating))) => {
            session.change(gesture.mark(), |project| {
                project.warp = Some(cell.warp());
                project.content = Some(cell.content());
            });
            let rating = rating.map_or(String::new(), |rating| format!(" ({rating})"));
            notices.done(format!("Best method: {}{rating}", cell.name()));
        }
        Some(Err(error)) => notices.problem(NoticeTopic::Transition, error.to_string()),
        None => {}
    }
    if trial.told().is_some() != was_busy {
        method_search.set_changed();
    }
}
