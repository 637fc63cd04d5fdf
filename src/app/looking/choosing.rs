//! Tries, beside the window, the methods that could suit the designs, and takes the one whose film
//! is the least trouble.

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::asking::hand::Gesture;
use crate::app::asking::intent::Intent;
use crate::app::session::state::Session;
use crate::app::telling::job::{Job, JobError};
use crate::app::telling::notices::{About, Notices};
use crate::measure::{Rating, auto};
use crate::progress::{Progress, Whole};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::Cell;

/// The method that was found, and how good its film is.
type Found = (Cell, Option<Rating>);

/// Methods that are being tried.
#[derive(Resource, Debug, Default)]
pub struct Choosing(Option<Trial>);

#[derive(Debug)]
struct Trial {
    /// The settings as they were when it began.
    of: Project,
    job: Job<Found, ProjectError>,
}

impl Choosing {
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
        let job = Job::start("the choice of a method", move |progress| {
            found(&staged, progress)
        });
        self.0 = Some(Trial { of, job });
    }

    /// The answer, once; what was found for other designs or options is none.
    fn take(&mut self, session: &Session) -> Option<Result<Found, JobError<ProjectError>>> {
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

fn found(loaded: &LoadedProject, progress: &dyn Progress) -> Result<Found, ProjectError> {
    let progress = &Whole::new(progress);
    let (transition, rating) = auto(&loaded.spec()?, progress)?;
    Ok((transition.cell(), rating))
}

/// Begins a trial that is asked for, stops one, and takes what was found.
pub fn apply(
    mut intents: MessageReader<Intent>,
    (mut session, mut choosing): (ResMut<Session>, ResMut<Choosing>),
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
        Some(Err(error)) => notices.problem(About::Transition, error.to_string()),
        None => {}
    }
    if trial.told().is_some() != was_busy {
        choosing.set_changed();
    }
}
