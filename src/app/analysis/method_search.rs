//! Method search: builds the film by each of three methods in the background, and uses the method
//! whose film has the fewest defects. The methods are rigid parts, distance fields carried by rigid
//! parts, and the plain blend of distance fields.

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::state::Session;
use crate::measure::{FilmRating, build_best_method};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::TransitionMethod;
use crate::work::progress::{OverallProgress, Progress};

/// The chosen method and the rating of its film. The rating is `None` for films of pictures.
type MethodChoice = (TransitionMethod, Option<FilmRating>);

/// The running method search; `None` while no search is running.
#[derive(Resource, Debug, Default)]
pub struct MethodSearch(Option<MethodSearchJob>);

/// A running search.
#[derive(Debug)]
struct MethodSearchJob {
    /// Settings for which the search was started.
    settings: Project,
    job: BackgroundJob<MethodChoice, ProjectError>,
}

impl MethodSearch {
    /// Progress of the search, in [0, 1]; `None` if no search is running.
    #[must_use]
    pub fn visible_progress(&self) -> Option<f64> {
        Some(self.0.as_ref()?.job.progress().1)
    }

    /// Cancels the search and keeps the current method.
    pub fn stop(&mut self) {
        // Dropping the job cancels it.
        self.0 = None;
    }

    /// Starts a search for the best method for the segment on the stage.
    fn start(&mut self, session: &Session) {
        let Some(staged) = session.staged_segment() else {
            return;
        };
        let settings = staged.project.clone();
        let job = BackgroundJob::start("the method search", move |progress| {
            search(&staged, progress)
        });
        self.0 = Some(MethodSearchJob { settings, job });
    }

    /// Result of a finished search, returned once. If the designs or options have changed since it
    /// started, the search is cancelled and has no result.
    fn take_result(
        &mut self,
        session: &Session,
    ) -> Option<Result<MethodChoice, JobError<ProjectError>>> {
        let search = self.0.as_ref()?;
        let is_same = |now: &Project| {
            (&now.designs, &now.options) == (&search.settings.designs, &search.settings.options)
        };
        if !session.project().is_some_and(is_same) {
            self.0 = None;
            return None;
        }
        let answer = search.job.poll()?;
        self.0 = None;
        Some(answer)
    }
}

/// Builds and rates the film of each suitable method; returns the best method and its rating.
fn search(loaded: &LoadedProject, progress: &dyn Progress) -> Result<MethodChoice, ProjectError> {
    let progress = &OverallProgress::new(progress);
    let (transition, rating) = build_best_method(&loaded.spec()?, progress)?;
    Ok((transition.method(), rating))
}

/// Starts or cancels a search on request, and applies the method it found.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut method_search: ResMut<MethodSearch>,
    mut notices: ResMut<Notices>,
    gesture: Res<Gesture>,
) {
    // This system runs in every screen update but seldom changes the resource. It bypasses Bevy's
    // change detection and reports changes itself.
    let search = method_search.bypass_change_detection();
    let was_busy = search.visible_progress().is_some();
    for intent in intents.read() {
        match intent {
            Intent::ChooseBestMethod => search.start(&session),
            Intent::CancelMethodSearch => search.stop(),
            _ => {}
        }
    }
    match search.take_result(&session) {
        Some(Ok((method, rating))) => {
            session.change(gesture.id(), |project| {
                project.warp = Some(method.warp());
                project.content = Some(method.content());
            });
            let rating = rating.map_or(String::new(), |rating| format!(" ({rating})"));
            notices.confirm(format!("Best method: {}{rating}", method.name()));
        }
        Some(Err(error)) => notices.problem(NoticeTopic::Transition, error.to_string()),
        None => {}
    }
    if search.visible_progress().is_some() != was_busy {
        method_search.set_changed();
    }
}
