//! Films of one pass, drawn and written in the background by the same code as on the command line.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy::prelude::{MessageReader, Res, ResMut, Resource};
use image::RgbaImage;

use crate::app::capture::film_request::{FilmExportError, FilmPreview, FilmRequest};
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CaptureFolder, ScratchFolder};
use crate::app::session::state::Session;

/// The recording that is going on, if any.
#[derive(Resource, Debug, Default)]
pub struct FilmExporter {
    job: Option<BackgroundJob<PathBuf, FilmExportError>>,
    preview: FilmPreview,
}

/// How long the end of the program waits for a cancelled recording: four times what it is to take.
const LAST_WAIT: Duration = Duration::from_secs(2);

impl FilmExporter {
    /// What is being recorded and how far it is.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.job.as_ref().map(|job| ("Writing", job.progress().1))
    }

    /// The frame that it has come to.
    #[must_use]
    pub fn preview(&self) -> Option<Arc<RgbaImage>> {
        self.job.as_ref().and_then(|_| self.preview.get())
    }

    /// Stops the recording; what was begun is taken away.
    pub fn cancel(&self) {
        if let Some(job) = &self.job {
            job.cancel();
        }
    }
}

impl Drop for FilmExporter {
    /// What was begun is taken away before the program ends.
    fn drop(&mut self) {
        self.cancel();
        let begun = Instant::now();
        while BackgroundJob::take(&mut self.job).is_none()
            && self.job.is_some()
            && begun.elapsed() < LAST_WAIT
        {
            std::thread::sleep(LAST_WAIT / 200);
        }
    }
}

/// Starts and cancels recordings.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut recorder: ResMut<FilmExporter>,
    mut notices: ResMut<Notices>,
    (session, preferences): (Res<Session>, Res<Preferences>),
    places: (Res<CaptureFolder>, Res<ScratchFolder>),
) {
    let new_order = || FilmRequest::new(&preferences, &session, (&places.0, &places.1));
    for intent in intents.read() {
        match intent {
            // The job stays until it has taken away what it began, and says then that it was
            // cancelled.
            Intent::CancelRecording => recorder.cancel(),
            Intent::Record | Intent::Compare if recorder.job.is_some() => {
                notices.done("A file is being written; wait for it, or cancel it first.");
            }
            Intent::Compare => {
                notices.well(NoticeTopic::Film);
                recorder.preview = FilmPreview::default();
                if let (Some(order), Some(staged)) = (new_order(), session.staged()) {
                    recorder.job = Some(BackgroundJob::start("a sheet", move |progress| {
                        order.compare(&staged, progress)
                    }));
                }
            }
            Intent::Record => {
                // What went wrong with the last one is past: it is tried again.
                notices.well(NoticeTopic::Film);
                recorder.preview = FilmPreview::default();
                let preview = recorder.preview.clone();
                recorder.job = new_order().map(|order| {
                    BackgroundJob::start("a film", move |progress| {
                        order.carry_out(&preview, progress)
                    })
                });
            }
            _ => {}
        }
    }
}

/// Says what was written.
pub fn report(mut recorder: ResMut<FilmExporter>, mut notices: ResMut<Notices>) {
    match BackgroundJob::take(&mut recorder.job) {
        None => {}
        Some(Ok(path)) => notices.wrote(path),
        Some(Err(JobError::Failed(FilmExportError::Cancelled))) => {
            notices.done(FilmExportError::Cancelled.to_string());
        }
        Some(Err(error)) => notices.problem(NoticeTopic::Film, error.to_string()),
    }
}
