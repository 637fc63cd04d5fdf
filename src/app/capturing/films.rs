//! Films of one pass, drawn and written in the background by the same code as on the command line.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use bevy::prelude::{MessageReader, Res, ResMut, Resource};

use crate::app::asking::choices::{FilmLook, Preferences, RecordFormat};
use crate::app::asking::intent::Intent;
use crate::app::capturing::files::{
    CaptureFolder, NewFileError, create_new, create_new_folder, whole,
};
use crate::app::capturing::framing::{FramingError, framed};
use crate::app::session::state::Session;
use crate::app::telling::job::{Job, JobError};
use crate::app::telling::notices::{About, Notices};

/// The recording that is going on, if any.
#[derive(Resource, Debug, Default)]
pub struct Recorder(Option<Job<PathBuf, RecordError>>);

/// Why a film or a sheet was not written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// It was not wanted any more.
    #[error("The recording was cancelled.")]
    Cancelled,
    /// The timing or the size make no film.
    #[error(transparent)]
    Film(#[from] FramingError),
    /// No file could be made for it.
    #[error(transparent)]
    File(#[from] NewFileError),
    /// The file is none that a film can go to.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The sheet would have no size.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// The settings do not go with the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// It could not be written.
    #[error(transparent)]
    Export(ExportError),
}

impl From<Cancelled> for RecordError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<ExportError> for RecordError {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Cancelled(_) => Self::Cancelled,
            error => Self::Export(error),
        }
    }
}

/// How long the end of the program waits for a cancelled recording: four times what it is to take.
const LAST_WAIT: Duration = Duration::from_secs(2);

/// The t of a sheet of all methods.
const COLUMNS: usize = 7;

impl Recorder {
    /// What is being recorded and how far it is.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.0.as_ref().map(|job| ("Writing", job.progress().1))
    }

    /// Stops the recording; what was begun is taken away.
    pub fn cancel(&self) {
        if let Some(job) = &self.0 {
            job.cancel();
        }
    }
}

impl Drop for Recorder {
    /// What was begun is taken away before the program ends.
    fn drop(&mut self) {
        self.cancel();
        let begun = Instant::now();
        while Job::take(&mut self.0).is_none() && self.0.is_some() && begun.elapsed() < LAST_WAIT {
            std::thread::sleep(LAST_WAIT / 200);
        }
    }
}

/// Starts and cancels recordings.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut recorder: ResMut<Recorder>,
    mut notices: ResMut<Notices>,
    (session, preferences, folder): (Res<Session>, Res<Preferences>, Res<CaptureFolder>),
) {
    let new_order = || Order::new(&preferences, &session, &folder);
    for intent in intents.read() {
        match intent {
            // The job stays until it has taken away what it began, and says then that it was
            // cancelled.
            Intent::CancelRecording => recorder.cancel(),
            Intent::Record | Intent::Compare if recorder.0.is_some() => {
                notices.done("A file is being written; wait for it, or cancel it first.");
            }
            Intent::Compare => {
                notices.well(About::Film);
                if let (Some(order), Some(staged)) = (new_order(), session.staged()) {
                    recorder.0 = Some(Job::start("a sheet", move |progress| {
                        order.compare(&staged, progress)
                    }));
                }
            }
            Intent::Record => {
                // What went wrong with the last one is past: it is tried again.
                notices.well(About::Film);
                recorder.0 = new_order()
                    .map(|order| Job::start("a film", move |progress| order.carry_out(progress)));
            }
            _ => {}
        }
    }
}

/// Says what was written.
pub fn report(mut recorder: ResMut<Recorder>, mut notices: ResMut<Notices>) {
    match Job::take(&mut recorder.0) {
        None => {}
        Some(Ok(path)) => notices.done(format!("Wrote {}", path.display())),
        Some(Err(JobError::Failed(RecordError::Cancelled))) => {
            notices.done(RecordError::Cancelled.to_string());
        }
        Some(Err(error)) => notices.problem(About::Film, error.to_string()),
    }
}
