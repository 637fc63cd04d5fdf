//! Measures the transition on the stage, beside the window.
//!
//! Whenever another transition is on the stage it is sampled over t and judged in words. A newer
//! transition stops the work on an older one; while a build is running, as when something is being
//! dragged, nothing is measured.

use std::time::Duration;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::analysis::transition_memo::TransitionMemo;
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::app::view::is_same;
use crate::measure::{FilmReport, Remedy, Verdict, film};
use crate::project::Project;
use crate::transition::Transition;
use crate::warp::WarpKind;
use crate::work::progress::{Cancelled, Progress, ProgressSpan, WholeProgress};

/// At how many t a film is measured: those of the verdict and of the plots. Both ends and 63
/// between them, a half and quarters among those; more would find shorter faults and take longer.
pub const STEPS: usize = 65;

/// What takes longer is told, and stopped by Esc: what is shorter is over before that is seen, and
/// Esc meant something else.
const WORTH_A_WORD: Duration = Duration::from_millis(1000);

/// A film in numbers and in words.
#[derive(Clone, Debug)]
pub struct FilmMeasures {
    /// The numbers against t.
    pub film: FilmReport,
    /// What goes wrong, where, why, and what helps.
    pub verdict: Verdict,
}

/// What is known of the transition on the stage.
#[derive(Resource, Debug, Default)]
pub struct StageMeasures {
    of: Option<Transition>,
    job: Option<BackgroundJob<FilmMeasures, Cancelled>>,
    measures: Option<FilmMeasures>,
    /// There is an answer, with measures or, where the work broke off, without.
    is_done: bool,
    /// Of other legs: while a sequence plays they come again and again.
    before: TransitionMemo<FilmMeasures>,
}

impl StageMeasures {
    /// The measures; while they are being taken, none.
    #[must_use]
    pub fn measures(&self) -> Option<&FilmMeasures> {
        self.measures.as_ref()
    }

    /// The measures are being taken.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// They were stopped, or the work on them broke off.
    #[must_use]
    pub fn is_broken_off(&self) -> bool {
        self.is_done && self.measures.is_none()
    }

    /// How far they are, 0 to 1, once that is worth a word.
    #[must_use]
    pub fn told(&self) -> Option<f64> {
        let job = self.job.as_ref().filter(|job| job.lasts() > WORTH_A_WORD)?;
        Some(job.progress().1)
    }

    /// Stops measuring what is on the stage.
    pub fn stop(&mut self) {
        // Dropped, the job hears that it is not wanted.
        self.is_done |= self.job.take().is_some();
    }

    fn follow(&mut self, session: &Session) {
        let transition = session.transition();
        if !is_same(self.of.as_ref(), transition) {
            // The job on the old one goes with it, which stops it.
            let mut before = std::mem::take(&mut self.before);
            if let (Some(of), Some(measures)) = (&self.of, self.measures.take()) {
                before.keep(of, measures);
            }
            let measures = transition.and_then(|transition| before.take(transition));
            *self = Self {
                of: transition.cloned(),
                is_done: measures.is_some(),
                measures,
                before,
                ..Self::default()
            };
        }
        if session.work().is_none() && !self.is_done && self.job.is_none() {
            self.job = self.of.clone().map(|transition| {
                BackgroundJob::start("the measures", move |progress| {
                    measured(&transition, progress)
                })
            });
        }
    }

    /// Whether there was an answer.
    fn take(&mut self) -> bool {
        let Some(answer) = BackgroundJob::take(&mut self.job) else {
            return false;
        };
        self.is_done = true;
        self.measures = answer.ok();
        true
    }
}

/// How much is done once there are numbers, of most films.
const SAMPLED: f64 = 0.8;

fn measured(transition: &Transition, progress: &dyn Progress) -> Result<FilmMeasures, Cancelled> {
    let progress = &WholeProgress::new(progress);
    let [sampling, judging] =
        [(0.0, SAMPLED), (SAMPLED, 1.0)].map(|(from, to)| ProgressSpan::new(progress, from, to));
    let film = film(transition, STEPS, &sampling)?;
    let verdict = Verdict::of_film(transition, &film, &judging)?;
    Ok(FilmMeasures { film, verdict })
}

/// Starts to measure what is new and takes in what was measured.
pub fn follow(session: Res<Session>, mut measured: ResMut<StageMeasures>) {
    // Marked as changed by hand: it is written to in each frame, and seldom new.
    let now = measured.bypass_change_detection();
    let was_busy = now.is_busy();
    let is_taken = now.take();
    now.follow(&session);
    if is_taken || now.is_busy() != was_busy {
        measured.set_changed();
    }
}

/// Does what the verdict advises, and measures what was broken off anew.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    (mut measured, gesture): (ResMut<StageMeasures>, Res<Gesture>),
) {
    for intent in intents.read() {
        if *intent == Intent::Measure && measured.is_broken_off() {
            *measured = StageMeasures::default();
        }
        let Intent::TakeAdvice(index) = *intent else {
            continue;
        };
        let findings = measured.measures().map(|m| &m.verdict.findings);
        let Some(finding) = findings.and_then(|all| all.get(index)) else {
            continue;
        };
        let remedy = finding.remedy.clone();
        session.change(gesture.mark(), |project| {
            follow_advice(project, &remedy);
        });
    }
}

/// Whether a remedy can be taken by a click: it was tried, or is sure to help.
#[must_use]
pub fn is_one_click(remedy: &Remedy) -> bool {
    matches!(
        remedy,
        Remedy::Change { .. } | Remedy::Lattices | Remedy::LetFold
    )
}

fn follow_advice(project: &mut Project, remedy: &Remedy) {
    match remedy {
        Remedy::Change { change, .. } => change.apply(&mut project.options),
        Remedy::Lattices => {
            project.warp = Some(WarpKind::Lattice);
            project.options.lattice.fold_free = true;
        }
        Remedy::LetFold => project.options.lattice.fold_free = false,
        // What these advise takes a hand, or a trial: `is_a_click` gives them no button.
        _ => {}
    }
}
