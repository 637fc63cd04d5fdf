//! Comparison: the same designs at the same t by a second method, shown to the right of the stage.
//!
//! The second transition is an entity on a separate render layer, seen by a separate camera. It is
//! built in the background with the same settings except for the method. If the stage already uses
//! that method, the comparison shows the transition of the stage.

use bevy::prelude::{
    Component, DetectChanges, DetectChangesMut, MessageReader, Res, ResMut, Resource,
};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::ComparisonMethod;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::session::load::transition_of;
use crate::app::session::state::Session;
use crate::app::session::transition_problem::TransitionProblem;
use crate::project::{LoadedProject, Project};
use crate::transition::{Transition, TransitionMethod};
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Progress;

/// The comparison: its settings, its transition, and the job that builds the transition.
#[derive(Resource, Debug, Default)]
pub struct Comparison {
    /// Whether the comparison is shown.
    pub is_shown: bool,
    /// Method chosen by the user; `None` uses the default for the content.
    pub method: Option<ComparisonMethod>,
    settings: Option<Project>,
    job: Option<BackgroundJob<Transition, TransitionProblem>>,
    transition: Option<Transition>,
    problem: Option<JobError<TransitionProblem>>,
}

/// Marks the entity that shows the compared transition.
#[derive(Component, Debug)]
pub struct OnComparison;

impl Comparison {
    /// The compared transition; `None` until it is built.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.transition.as_ref()
    }

    /// Reason why the compared transition could not be built; `None` if there is no problem.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<TransitionProblem>> {
        self.problem.as_ref()
    }

    /// Whether the compared transition is being built.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Method with which a project is compared: the user's choice, or the default for its content.
    #[must_use]
    pub fn method_for(&self, project: &Project) -> ComparisonMethod {
        self.method
            .unwrap_or(ComparisonMethod::default_for(project.content))
    }

    /// Discards the compared transition; keeps the user's choices.
    fn discard(&mut self) {
        *self = Self {
            is_shown: self.is_shown,
            method: self.method,
            ..Self::default()
        };
    }

    /// Starts building the compared transition if the settings on the stage or the second method
    /// have changed.
    fn start_if_changed(&mut self, session: &Session) {
        let Some(staged) = session.staged_segment() else {
            self.discard();
            return;
        };
        let now = staged.project.clone();
        let mut compared = staged;
        set_method(self.method_for(&now), &mut compared.project);
        // A failed build is not repeated: the same settings would fail the same way.
        if self.settings.as_ref() == Some(&compared.project) {
            return;
        }
        // The old transition stays until the new one is ready, as on the stage.
        self.settings = Some(compared.project.clone());
        self.problem = None;
        if compared.project == now {
            self.job = None;
            self.transition = session.transition().cloned();
        } else {
            self.job = Some(BackgroundJob::start("the comparison", move |progress| {
                build_comparison(&compared, progress)
            }));
        }
    }

    /// Collects the result of a finished build; returns whether there was one.
    fn collect_result(&mut self) -> bool {
        let Some(answer) = BackgroundJob::take_result(&mut self.job) else {
            return false;
        };
        (self.transition, self.problem) = match answer {
            Ok(transition) => (Some(transition), None),
            Err(problem) => (None, Some(problem)),
        };
        true
    }
}

/// Builds the transition to compare with, if the designs support its method.
fn build_comparison(
    project: &LoadedProject,
    progress: &dyn Progress,
) -> Result<Transition, TransitionProblem> {
    let (warp, content) = (project.project.warp, project.project.content);
    if let (Some(warp), Some(content)) = (warp, content) {
        project.check_available(warp, content)?;
    }
    transition_of(project, progress)
}

/// Applies the intents that concern the comparison.
pub fn apply(mut intents: MessageReader<Intent>, mut comparison: ResMut<Comparison>) {
    for intent in intents.read() {
        match intent {
            Intent::ToggleComparison => comparison.is_shown = !comparison.is_shown,
            Intent::SetComparisonMethod(method) => comparison.method = Some(*method),
            _ => {}
        }
    }
}

/// Starts building the comparison while it is shown, collects the result, and discards it once the
/// comparison is hidden.
pub fn follow(session: Res<Session>, mut comparison: ResMut<Comparison>) {
    let is_new = session.is_changed() || comparison.is_changed();
    let now = comparison.bypass_change_detection();
    let has_result = now.collect_result();
    if !now.is_shown {
        // The comparison is discarded only once; otherwise every screen update would report a
        // change.
        if now.settings.is_some() {
            now.discard();
            comparison.set_changed();
        }
        return;
    }
    // While the stage's transition is being built, the settings to compare with are about to
    // change.
    if is_new && session.work().is_none() {
        comparison.start_if_changed(&session);
    } else if has_result {
        comparison.set_changed();
    }
}

/// Changes the settings of a project so that the project uses the method `method`.
fn set_method(method: ComparisonMethod, project: &mut Project) {
    let cell = method.method();
    (project.warp, project.content) = (Some(cell.warp()), Some(cell.content()));
    match method {
        ComparisonMethod::Straight => {
            // With the linear homotopy, all vertices of the ARAP solution move along straight
            // lines.
            project.options.arap.homotopy = Homotopy::Linear;
            project.options.arap.extra_turns.clear();
        }
        ComparisonMethod::Method(TransitionMethod::RIGID_PARTS)
            if project.options.arap.homotopy == Homotopy::Linear =>
        {
            project.options.arap.homotopy = Homotopy::Polar;
        }
        ComparisonMethod::Method(_) => {}
    }
}
