//! Measures the film on the stage in the background and checks it for defects.
//!
//! A new transition cancels the work on the previous one. Nothing is measured while a transition is
//! being built, for example while the user drags a slider.

use std::time::Duration;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::analysis::is_same;
use crate::app::analysis::transition_memo::TransitionMemo;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::measure::{FilmReport, Verdict, film_report};
use crate::structure::{FilmStructure, StructureError, StructureLimits, has_structure};
use crate::transition::Transition;
use crate::work::progress::{Cancelled, OverallProgress, Progress, ProgressSpan};

/// Number of values of t at which a film is sampled for the check and the graphs: 0, 1 and 63
/// evenly spaced values between them, among them 1/4, 1/2 and 3/4. More samples would find shorter
/// defects and take longer (heuristic).
pub const FILM_SAMPLES: usize = 65;

/// Time after which a running measurement is shown as work in progress and can be cancelled with
/// Esc. A measurement that takes less time ends before the user could react to it (heuristic).
const SHOWN_AFTER: Duration = Duration::from_millis(1000);

/// Measures of a film over time, and the result of the check.
#[derive(Clone, Debug)]
pub struct FilmMeasures {
    /// Measures of the film as functions of t.
    pub film: FilmReport,
    /// The defects found, with their place, cause and remedy.
    pub verdict: Verdict,
    /// Analysis of two trusses with supports or loads, or the reason why they cannot be analysed;
    /// `None` for all other designs.
    pub structure: Option<Result<FilmStructure, StructureError>>,
}

/// Measures of the transition on the stage, and the background job that computes them.
#[derive(Resource, Debug, Default)]
pub struct StageMeasures {
    transition: Option<Transition>,
    job: Option<BackgroundJob<FilmMeasures, Cancelled>>,
    measures: Option<FilmMeasures>,
    /// Whether measuring has ended; if it was cancelled or failed, `measures` is `None`.
    is_done: bool,
    /// Measures of other segments of the film. They are reused when playback puts those segments on
    /// the stage again.
    memo: TransitionMemo<FilmMeasures>,
}

impl StageMeasures {
    /// The measures; `None` until measuring is complete, or if it was cancelled or failed.
    #[must_use]
    pub fn measures(&self) -> Option<&FilmMeasures> {
        self.measures.as_ref()
    }

    /// Whether the film is being measured.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Whether measuring was cancelled or failed.
    #[must_use]
    pub fn was_stopped(&self) -> bool {
        self.is_done && self.measures.is_none()
    }

    /// Progress of measuring, in [0, 1]; `None` until it has taken long enough to be shown.
    #[must_use]
    pub fn visible_progress(&self) -> Option<f64> {
        let job = self
            .job
            .as_ref()
            .filter(|job| job.elapsed() > SHOWN_AFTER)?;
        Some(job.progress().1)
    }

    /// Cancels measuring.
    pub fn stop(&mut self) {
        // Dropping the job cancels it.
        self.is_done |= self.job.take().is_some();
    }

    /// Switches to the transition on the stage, and starts measuring it once no build is running.
    fn adopt_stage(&mut self, session: &Session) {
        let transition = session.transition();
        if !is_same(self.transition.as_ref(), transition) {
            // Replacing `self` also cancels the job for the old transition.
            let mut memo = std::mem::take(&mut self.memo);
            if let (Some(old), Some(measures)) = (&self.transition, self.measures.take()) {
                memo.insert(old, measures);
            }
            let measures = transition.and_then(|transition| memo.take(transition));
            *self = Self {
                transition: transition.cloned(),
                is_done: measures.is_some(),
                measures,
                memo,
                ..Self::default()
            };
        }
        if session.work().is_none() && !self.is_done && self.job.is_none() {
            self.job = self.transition.clone().map(|transition| {
                BackgroundJob::start("measuring the film", move |progress| {
                    measure_film(&transition, progress)
                })
            });
        }
    }

    /// Collects the result of a finished measurement; returns whether there was one.
    fn collect_result(&mut self) -> bool {
        let Some(answer) = BackgroundJob::take_result(&mut self.job) else {
            return false;
        };
        self.is_done = true;
        self.measures = answer.ok();
        true
    }
}

/// Share of the measurement's progress that sampling takes (heuristic).
const SAMPLING_SHARE: f64 = 0.7;

/// Progress of the measurement once the film is checked; the structure takes the rest (heuristic).
const CHECKED_SHARE: f64 = 0.85;

/// Samples the film, checks it for defects, and analyses the structure of trusses.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
pub fn measure_film(
    transition: &Transition,
    progress: &dyn Progress,
) -> Result<FilmMeasures, Cancelled> {
    let progress = &OverallProgress::new(progress);
    let [sampling, checking, analysing] = [
        (0.0, SAMPLING_SHARE),
        (SAMPLING_SHARE, CHECKED_SHARE),
        (CHECKED_SHARE, 1.0),
    ]
    .map(|(from, to)| ProgressSpan::new(progress, from, to));
    let film = film_report(transition, FILM_SAMPLES, &sampling)?;
    let verdict = Verdict::of_film(transition, &film, &checking)?;
    let structure = has_structure(transition).then(|| {
        let limits = StructureLimits::default();
        FilmStructure::of(transition, FilmStructure::SAMPLES, &limits, &analysing)
    });
    if let Some(Err(StructureError::Cancelled(cancelled))) = structure {
        return Err(cancelled);
    }
    Ok(FilmMeasures {
        film,
        verdict,
        structure,
    })
}

/// Starts measuring a new transition and collects results.
pub fn follow(session: Res<Session>, mut stage_measures: ResMut<StageMeasures>) {
    // This system runs in every screen update but seldom changes the resource. It bypasses Bevy's
    // change detection and reports changes itself.
    let now = stage_measures.bypass_change_detection();
    let was_busy = now.is_busy();
    let is_taken = now.collect_result();
    now.adopt_stage(&session);
    if is_taken || now.is_busy() != was_busy {
        stage_measures.set_changed();
    }
}

/// Restarts cancelled measuring.
pub fn apply(mut intents: MessageReader<Intent>, mut stage_measures: ResMut<StageMeasures>) {
    for intent in intents.read() {
        if *intent == Intent::MeasureAgain && stage_measures.was_stopped() {
            *stage_measures = StageMeasures::default();
        }
    }
}
