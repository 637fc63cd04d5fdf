//! Exports films and comparison sheets in the background, with the same code as the command line.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy::prelude::{MessageReader, Res, ResMut, Resource};
use image::RgbaImage;

use crate::app::capture::film_request::{FilmExportError, FilmPreview, FilmRequest};
use crate::app::input::intent::{ExportKind, Intent};
use crate::app::input::preferences::Preferences;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::ScratchFolder;
use crate::app::session::state::Session;

/// The film export in progress, if any.
#[derive(Resource, Debug, Default)]
pub struct FilmExporter {
    job: Option<BackgroundJob<PathBuf, FilmExportError>>,
    preview: FilmPreview,
}

/// Maximum time for which the program, on exit, waits until a cancelled export has deleted its
/// partial file (resource limit: four times the expected time).
const EXIT_WAIT: Duration = Duration::from_secs(2);

impl FilmExporter {
    /// Text and progress, in [0, 1], of the running export; `None` if no export is running.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.job.as_ref().map(|job| ("Exporting", job.progress().1))
    }

    /// Image of the film frame being exported; `None` until the first image is drawn, and while no
    /// export is running.
    #[must_use]
    pub fn preview(&self) -> Option<Arc<RgbaImage>> {
        self.job.as_ref().and_then(|_| self.preview.get())
    }

    /// Cancels the export; its partial file is deleted.
    pub fn cancel(&self) {
        if let Some(job) = &self.job {
            job.cancel();
        }
    }
}

impl Drop for FilmExporter {
    /// Cancels the export and waits, for at most `EXIT_WAIT`, until its partial file is deleted.
    fn drop(&mut self) {
        self.cancel();
        let started = Instant::now();
        while BackgroundJob::take_result(&mut self.job).is_none()
            && self.job.is_some()
            && started.elapsed() < EXIT_WAIT
        {
            std::thread::sleep(EXIT_WAIT / 200);
        }
    }
}

/// Starts and cancels exports.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut exporter: ResMut<FilmExporter>,
    mut notices: ResMut<Notices>,
    session: Res<Session>,
    preferences: Res<Preferences>,
    scratch: Res<ScratchFolder>,
) {
    let new_request = || FilmRequest::new(&preferences, &session, &scratch);
    for intent in intents.read() {
        match intent {
            // The job remains until it has deleted its partial file, and then reports that it was
            // cancelled.
            Intent::CancelExport => exporter.cancel(),
            Intent::AskExport(_) | Intent::Export(..) if exporter.job.is_some() => {
                notices.confirm("An export is already running. Wait for it, or cancel it first");
            }
            Intent::Export(ExportKind::MethodSheet, path) => {
                let path = path.clone();
                notices.resolve(NoticeTopic::Film);
                exporter.preview = FilmPreview::default();
                if let (Some(request), Some(staged)) = (new_request(), session.staged_segment()) {
                    exporter.job = Some(BackgroundJob::start(
                        "the comparison sheet",
                        move |progress| request.export_method_sheet(&staged, &path, progress),
                    ));
                }
            }
            Intent::Export(ExportKind::Film, path) => {
                let path = path.clone();
                // Problems of the last export are no longer of interest.
                notices.resolve(NoticeTopic::Film);
                exporter.preview = FilmPreview::default();
                let preview = exporter.preview.clone();
                exporter.job = new_request().map(|request| {
                    BackgroundJob::start("the film export", move |progress| {
                        request.export(&path, &preview, progress)
                    })
                });
            }
            _ => {}
        }
    }
}

/// Reports the result of an export.
pub fn report(mut exporter: ResMut<FilmExporter>, mut notices: ResMut<Notices>) {
    match BackgroundJob::take_result(&mut exporter.job) {
        None => {}
        Some(Ok(path)) => notices.file_written(path),
        Some(Err(JobError::Failed(FilmExportError::Cancelled))) => {
            notices.confirm(FilmExportError::Cancelled.to_string());
        }
        Some(Err(error)) => notices.problem(NoticeTopic::Film, error.to_string()),
    }
}
