//! What the film that would be written costs: some frames of it are written to see.

use std::time::{Duration, Instant};

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::capture::film_exporter::FilmExporter;
use crate::app::capture::film_request::{FilmCost, FilmExportError, FilmRequest};
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, Preferences};
use crate::app::jobs::job::BackgroundJob;
use crate::app::output_files::{CaptureFolder, ScratchFolder};
use crate::app::session::state::Session;

/// How long nothing must have changed: a slider that is dragged is not followed.
const CALM: Duration = Duration::from_millis(500);

/// What the cost hangs on, besides the project.
type EstimateKey = (FilmExportOptions, Option<FilmFileFormat>);

/// What the film costs, while its options are open.
#[derive(Resource, Debug, Default)]
pub struct ExportEstimate {
    of: Option<EstimateKey>,
    since: Option<Instant>,
    job: Option<BackgroundJob<FilmCost, FilmExportError>>,
    cost: Option<FilmCost>,
}

impl ExportEstimate {
    /// What it costs, once that is known.
    #[must_use]
    pub fn cost(&self) -> Option<FilmCost> {
        self.cost
    }

    /// It is being found out.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.since.is_some() || self.job.is_some()
    }
}

/// Keeps up with what would be written.
pub fn follow(
    mut estimate: ResMut<ExportEstimate>,
    (session, preferences): (Res<Session>, Res<Preferences>),
    places: (Res<CaptureFolder>, Res<ScratchFolder>),
    recorder: Res<FilmExporter>,
) {
    let is_open = preferences.film_options && preferences.panels;
    let wanted = is_open.then_some((preferences.film, preferences.record_format));
    // Looked at in each frame; only an answer is a change.
    let now = estimate.bypass_change_detection();
    if now.of != wanted || session.is_changed() {
        (now.job, now.cost) = (None, None);
        now.since = wanted.map(|_| Instant::now());
        now.of = wanted;
    }
    let is_calm = now.since.is_some_and(|since| since.elapsed() >= CALM);
    // A film that is being written would take twice as long, and so would this.
    if is_calm && session.work().is_none() && recorder.work().is_none() {
        now.since = None;
        now.job = FilmRequest::new(&preferences, &session, (&places.0, &places.1)).map(|order| {
            BackgroundJob::start("an estimate", move |progress| order.tried(progress))
        });
    }
    if let Some(answer) = BackgroundJob::take(&mut now.job) {
        // Where it fails, writing the film says why.
        now.cost = answer.ok();
        estimate.set_changed();
    }
}
