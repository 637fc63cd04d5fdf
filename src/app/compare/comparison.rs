//! The twin view: the same designs at the same t by a second method, beside the first.
//!
//! The second transition is an entity on the stage like the first, on a render layer of its own
//! that a camera of its own shows. It is built beside the window, from the same settings but for
//! the method; where the stage shows that method already, it is the same transition.

use bevy::prelude::{
    Component, DetectChanges, DetectChangesMut, MessageReader, Res, ResMut, Resource,
};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::ComparisonMethod;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::session::load::{TransitionProblem, transition_of};
use crate::app::session::state::Session;
use crate::project::{LoadedProject, Project};
use crate::transition::{Transition, TransitionMethod};
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Progress;

/// What stands beside the stage.
#[derive(Resource, Debug, Default)]
pub struct Comparison {
    /// It is shown.
    pub is_shown: bool,
    /// By which method, once one was chosen.
    pub method: Option<ComparisonMethod>,
    settings: Option<Project>,
    job: Option<BackgroundJob<Transition, TransitionProblem>>,
    transition: Option<Transition>,
    problem: Option<JobError<TransitionProblem>>,
}

/// The entity that is beside the stage.
#[derive(Component, Debug)]
pub struct OnComparison;

impl Comparison {
    /// What is beside the stage.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.transition.as_ref()
    }

    /// Why there is nothing beside the stage.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<TransitionProblem>> {
        self.problem.as_ref()
    }

    /// It is being built.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// The method beside a project: what was chosen, or else the plainest.
    #[must_use]
    pub fn method_beside(&self, project: &Project) -> ComparisonMethod {
        self.method
            .unwrap_or(ComparisonMethod::plainest(project.content))
    }

    fn forget(&mut self) {
        *self = Self {
            is_shown: self.is_shown,
            method: self.method,
            ..Self::default()
        };
    }

    fn follow(&mut self, session: &Session) {
        let Some(staged) = session.staged() else {
            self.forget();
            return;
        };
        let now = staged.project.clone();
        let mut wanted = staged;
        set(self.method_beside(&now), &mut wanted.project);
        // Also where that came to nothing: the same settings would fail the same way.
        if self.settings.as_ref() == Some(&wanted.project) {
            return;
        }
        // What is shown stays until the new one is there, as on the stage.
        self.settings = Some(wanted.project.clone());
        self.problem = None;
        if wanted.project == now {
            self.job = None;
            self.transition = session.transition().cloned();
        } else {
            self.job = Some(BackgroundJob::start("the second method", move |progress| {
                built(&wanted, progress)
            }));
        }
    }

    /// Whether something was taken in.
    fn take(&mut self) -> bool {
        let Some(answer) = BackgroundJob::take(&mut self.job) else {
            return false;
        };
        (self.transition, self.problem) = match answer {
            Ok(transition) => (Some(transition), None),
            Err(problem) => (None, Some(problem)),
        };
        true
    }
}

fn built(
    project: &LoadedProject,
    progress: &dyn Progress,
) -> Result<Transition, TransitionProblem> {
    let (warp, content) = (project.project.warp, project.project.content);
    if let (Some(warp), Some(content)) = (warp, content) {
        project.available(warp, content)?;
    }
    transition_of(project, progress)
}

/// Acts on the intents that concern the twin view.
pub fn apply(mut intents: MessageReader<Intent>, mut twin: ResMut<Comparison>) {
    for intent in intents.read() {
        match intent {
            Intent::ToggleTwin => twin.is_shown = !twin.is_shown,
            Intent::TwinMethod(method) => twin.method = Some(*method),
            _ => {}
        }
    }
}

/// Builds what is to be beside the stage and takes it in.
pub fn follow(session: Res<Session>, mut twin: ResMut<Comparison>) {
    let is_new = session.is_changed() || twin.is_changed();
    let now = twin.bypass_change_detection();
    let is_taken = now.take();
    if !now.is_shown {
        // Once: what is forgotten each frame would be new each frame.
        if now.settings.is_some() {
            now.forget();
            twin.set_changed();
        }
        return;
    }
    // While the first is being built, what the second is held against is about to change.
    if is_new && session.work().is_none() {
        twin.follow(&session);
    } else if is_taken {
        twin.set_changed();
    }
}

/// The settings of a project, by this method.
fn set(method: ComparisonMethod, project: &mut Project) {
    let cell = method.cell();
    (project.warp, project.content) = (Some(cell.warp()), Some(cell.content()));
    match method {
        ComparisonMethod::Straight => {
            // Linear local maps are those of straight lines, and no others: what is as rigid
            // as possible then is the straight lines themselves.
            project.options.arap.homotopy = Homotopy::Linear;
            project.options.arap.extra_turns.clear();
        }
        ComparisonMethod::Cell(TransitionMethod::RIGID_PARTS)
            if project.options.arap.homotopy == Homotopy::Linear =>
        {
            project.options.arap.homotopy = Homotopy::Polar;
        }
        ComparisonMethod::Cell(_) => {}
    }
}
