//! Records the transition on the stage and checks its film at every t for folded faces and crossing
//! outlines, in the background.
//!
//! The transition can be played at once. When its recording is ready, playback reads the recording
//! instead of computing each in-between, without a visible change. The recording is then checked at
//! every t, not only at samples; the result of this proof appears below the stage.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::analysis::is_same;
use crate::app::analysis::transition_memo::TransitionMemo;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::session::state::Session;
use crate::recording::{RecordingError, RecordingOptions};
use crate::transition::{Transition, TransitionProof};

/// Recording and proof of the transition on the stage: the job in progress, or its result.
#[derive(Resource, Debug, Default)]
pub struct StageRecording {
    options: RecordingOptions,
    transition: Option<Transition>,
    job: Option<BackgroundJob<Option<TransitionProof>, RecordingError>>,
    proof: Option<TransitionProof>,
    error: Option<RecordingError>,
    /// Proofs for other segments of the film. They are reused when playback puts those segments on
    /// the stage again.
    memo: TransitionMemo<TransitionProof>,
}

impl StageRecording {
    /// Creates the resource with a memory limit for each recording, in MiB; `None` is the default
    /// limit.
    #[must_use]
    pub fn with_memory_limit(mebibytes: Option<usize>) -> Self {
        let defaults = RecordingOptions::default();
        let max_bytes = mebibytes.map_or(defaults.max_bytes, |mib| mib.saturating_mul(1 << 20));
        Self {
            options: RecordingOptions {
                max_bytes,
                ..defaults
            },
            ..Self::default()
        }
    }

    /// Reason why the transition on the stage could not be recorded or checked; `None` if there was
    /// no error.
    #[must_use]
    pub fn recording_error(&self) -> Option<&RecordingError> {
        self.error.as_ref()
    }

    /// Result of checking the film on the stage for folds and crossings at every t. `None` until
    /// the check is complete, and for distance fields, pictures and trusses, which are not checked.
    #[must_use]
    pub fn proof(&self) -> Option<&TransitionProof> {
        self.proof.as_ref()
    }

    /// Name of the current step of the recording or proof, and the last reported progress of both
    /// together, in [0, 1]; `None` if neither is in progress.
    #[must_use]
    pub fn progress(&self) -> Option<(&'static str, f64)> {
        self.job.as_ref().map(BackgroundJob::progress)
    }

    /// Whether a recording or proof is in progress.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Stores the current proof for later and cancels the recording in progress.
    fn cache_proof(&mut self) {
        // Dropping the job cancels it.
        self.job = None;
        if let Some((transition, proved)) = self.transition.take().zip(self.proof.take()) {
            self.memo.insert(&transition, proved);
        }
    }

    /// Restores the cached proof of a transition that is on the stage again; returns whether the
    /// cache contained one.
    fn restore_proof(&mut self) -> bool {
        self.proof = self
            .transition
            .as_ref()
            .and_then(|transition| self.memo.take(transition));
        self.proof.is_some()
    }
}

/// Records every new transition on the stage; a recording of the previous one is cancelled.
pub fn follow(session: Res<Session>, mut recording: ResMut<StageRecording>) {
    // This system runs in every screen update but seldom changes the resource. It bypasses Bevy's
    // change detection and reports changes itself.
    let now = recording.bypass_change_detection();
    if session.is_changed() && !is_same(now.transition.as_ref(), session.transition()) {
        now.cache_proof();
        now.error = None;
        let options = now.options;
        now.transition = session.transition().cloned();
        if now.restore_proof() {
            recording.set_changed();
            return;
        }
        now.job = now.transition.clone().map(|transition| {
            BackgroundJob::start("the recording", move |progress| {
                let recorded = transition.record(&options, progress);
                recorded.and_then(|_| transition.prove(&options, progress))
            })
        });
    }
    if let Some(answer) = BackgroundJob::take_result(&mut now.job) {
        // If the transition could not be recorded, the overlay of drawing times shows the reason.
        (now.proof, now.error) = match answer {
            Ok(proved) => (proved, None),
            Err(JobError::Failed(error)) => (None, Some(error)),
            Err(JobError::Panicked(_)) => (None, None),
        };
        recording.set_changed();
    }
}
