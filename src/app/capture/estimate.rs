//! Estimates the size and duration of a film export by exporting a few film frames.

use std::time::{Duration, Instant};

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::capture::film_exporter::FilmExporter;
use crate::app::capture::film_request::{FilmExportError, FilmRequest};
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, Preferences};
use crate::app::jobs::job::BackgroundJob;
use crate::app::output_files::ScratchFolder;
use crate::app::session::state::Session;
use crate::export::FilmCost;

/// Time without changes of the project or the export settings before an estimate starts, so that a
/// dragged slider triggers none (heuristic).
const QUIET_TIME: Duration = Duration::from_millis(500);

/// Export preferences for which an estimate was made. A new estimate is made when the preferences
/// or the project change.
type EstimateKey = (FilmExportOptions, Option<FilmFileFormat>);

/// Estimate for the current export settings; made only while the settings are shown.
#[derive(Resource, Debug, Default)]
pub struct ExportEstimate {
    key: Option<EstimateKey>,
    since: Option<Instant>,
    job: Option<BackgroundJob<FilmCost, FilmExportError>>,
    cost: Option<FilmCost>,
}

impl ExportEstimate {
    /// Estimated duration and size of the export; `None` until the estimate is complete.
    #[must_use]
    pub fn cost(&self) -> Option<FilmCost> {
        self.cost
    }

    /// Whether an estimate is running or about to start.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.since.is_some() || self.job.is_some()
    }
}

/// Restarts the estimate when settings change, and collects its result.
pub fn follow(
    mut estimate: ResMut<ExportEstimate>,
    session: Res<Session>,
    preferences: Res<Preferences>,
    scratch: Res<ScratchFolder>,
    exporter: Res<FilmExporter>,
) {
    let is_open = preferences.film_options && preferences.panels;
    let key = is_open.then_some((preferences.film, preferences.record_format));
    // This system runs in every screen update; only a new result marks the estimate as changed.
    let now = estimate.bypass_change_detection();
    if now.key != key || session.is_changed() {
        (now.job, now.cost) = (None, None);
        now.since = key.map(|_| Instant::now());
        now.key = key;
    }
    let is_quiet = now.since.is_some_and(|since| since.elapsed() >= QUIET_TIME);
    // No estimate runs during a build or an export: the two would slow each other down, and the
    // estimated duration would be wrong.
    if is_quiet && session.work().is_none() && exporter.work().is_none() {
        now.since = None;
        now.job = FilmRequest::new(&preferences, &session, &scratch).map(|request| {
            BackgroundJob::start("the export estimate", move |progress| {
                request.estimate_cost(progress)
            })
        });
    }
    if let Some(answer) = BackgroundJob::take_result(&mut now.job) {
        // A failed estimate is not reported; the export itself reports the reason.
        now.cost = answer.ok();
        estimate.set_changed();
    }
}
