//! The film of what is on the stage, recorded and proved beside the window.
//!
//! What is on the stage plays from the moment it is there; once its film is recorded,
//! the same frames come from memory. Nothing is drawn anew for it: it is the same film.
//! Then it is looked at at every t, which the verdict below the stage tells.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::analysis::transition_memo::TransitionMemo;
use crate::app::jobs::allocator::give_back;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::session::state::Session;
use crate::app::view::is_same;
use crate::recording::{RecordingError, RecordingOptions};
use crate::transition::{Transition, TransitionProof};

/// The recording that goes on, or what came of the last one.
#[derive(Resource, Debug, Default)]
pub struct StageRecording {
    options: RecordingOptions,
    of: Option<Transition>,
    job: Option<BackgroundJob<Option<TransitionProof>, RecordingError>>,
    proved: Option<TransitionProof>,
    refused: Option<RecordingError>,
    /// Of other legs: while a sequence plays they come again and again.
    before: TransitionMemo<TransitionProof>,
}

impl StageRecording {
    /// Of films that take so many MiB at most, or as many as they usually may.
    #[must_use]
    pub fn within(mebibytes: Option<usize>) -> Self {
        let usual = RecordingOptions::default();
        let most = mebibytes.map_or(usual.most_bytes, |most| most.saturating_mul(1 << 20));
        Self {
            options: RecordingOptions {
                most_bytes: most,
                ..usual
            },
            ..Self::default()
        }
    }

    /// Why there is no film of what is on the stage, nor will be.
    #[must_use]
    pub fn refused(&self) -> Option<&RecordingError> {
        self.refused.as_ref()
    }

    /// What is proved of the film on the stage; none as long as that is not known, and
    /// of what has no faces.
    #[must_use]
    pub fn proved(&self) -> Option<&TransitionProof> {
        self.proved.as_ref()
    }

    /// What is being done for the film, and how far it is.
    #[must_use]
    pub fn progress(&self) -> Option<(&'static str, f64)> {
        self.job.as_ref().map(BackgroundJob::progress)
    }

    /// It is being recorded, or proved.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    fn remember(&mut self) {
        // What was being recorded is given up.
        self.job = None;
        if let Some((of, proved)) = self.of.take().zip(self.proved.take()) {
            self.before.keep(&of, proved);
        }
    }

    /// Whether what is on the stage was there before, and recorded.
    fn recall(&mut self) -> bool {
        self.proved = self.of.as_ref().and_then(|of| self.before.take(of));
        self.proved.is_some()
    }
}

/// Records whatever is on the stage. A recording of what was there before is given up.
pub fn follow(session: Res<Session>, mut recording: ResMut<StageRecording>) {
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let now = recording.bypass_change_detection();
    if session.is_changed() && !is_same(now.of.as_ref(), session.transition()) {
        now.remember();
        now.refused = None;
        let options = now.options;
        now.of = session.transition().cloned();
        if now.recall() {
            recording.set_changed();
            return;
        }
        now.job = now.of.clone().map(|transition| {
            BackgroundJob::start("the film", move |progress| {
                let recorded = transition.record(&options, progress);
                let proved = recorded.and_then(|_| transition.prove(&options, progress));
                // What was on the stage before is gone by now.
                give_back();
                proved
            })
        });
    }
    if let Some(answer) = BackgroundJob::take(&mut now.job) {
        // Why there is no film is shown beside the times.
        (now.proved, now.refused) = match answer {
            Ok(proved) => (proved, None),
            Err(JobError::Failed(error)) => (None, Some(error)),
            Err(JobError::Broken(_)) => (None, None),
        };
        recording.set_changed();
    }
}
