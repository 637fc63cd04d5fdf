//! Tries, beside the window, the methods that could suit the designs, and takes the one whose film
//! is the least trouble.

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

/// The method that was found, and how good its film is.
type MethodChoice = (TransitionMethod, Option<FilmRating>);

/// Methods that are being tried.
#[derive(Resource, Debug, Default)]
pub struct MethodSearch(Option<MethodSearchJob>);

#[derive(Debug)]
struct MethodSearchJob {
    /// The settings as they were when it began.
    of: Project,
    job: BackgroundJob<MethodChoice, ProjectError>,
}

impl MethodSearch {
    /// How far the trial is, 0 to 1; none while nothing is tried.
    #[must_use]
    pub fn told(&self) -> Option<f64> {
        Some(self.0.as_ref()?.job.progress().1)
    }

    /// Leaves the method as it is.
    pub fn stop(&mut self) {
        // Dropped, the job hears that it is not wanted.
        self.0 = None;
    }

    fn start(&mut self, session: &Session) {
        let Some(staged) = session.staged() else {
            return;
        };
        let of = staged.project.clone();
        let job = BackgroundJob::start("the choice of a method", move |progress| {
            found(&staged, progress)
        });
        self.0 = Some(MethodSearchJob { of, job });
    }

    /// The answer, once; what was found for other designs or options is none.
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

fn found(loaded: &LoadedProject, progress: &dyn Progress) -> Result<MethodChoice, ProjectError> {
    let progress = &WholeProgress::new(progress);
    let (transition, rating) = auto(&loaded.spec()?, progress)?;
    Ok((transition.cell(), rating))
}

/// Begins a trial that is asked for, stops one, and takes what was found.
pub fn apply(
    mut intents: MessageReader<Intent>,
    (mut session, mut choosing): (ResMut<Session>, ResMut<MethodSearch>),
    (mut notices, gesture): (ResMut<Notices>, Res<Gesture>),
) {
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let trial = choosing.bypass_change_detection();
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
            notices.done(format!("The least trouble: {}{rating}.", cell.name()));
        }
        Some(Err(error)) => notices.problem(NoticeTopic::Transition, error.to_string()),
        None => {}
    }
    if trial.told().is_some() != was_busy {
        choosing.set_changed();
    }
}
