//! What the film that would be written costs: some frames of it are written to see.

use std::time::{Duration, Instant};

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::asking::choices::{FilmLook, Preferences, RecordFormat};
use crate::app::capturing::files::{CaptureFolder, Workshop};
use crate::app::capturing::films::Recorder;
use crate::app::capturing::order::{Cost, Order, RecordError};
use crate::app::session::state::Session;
use crate::app::telling::job::Job;

/// How long nothing must have changed: a slider that is dragged is not followed.
const CALM: Duration = Duration::from_millis(500);

/// What the cost hangs on, besides the project.
type Wanted = (FilmLook, Option<RecordFormat>);

/// What the film costs, while its options are open.
#[derive(Resource, Debug, Default)]
pub struct Estimate {
    of: Option<Wanted>,
    since: Option<Instant>,
    job: Option<Job<Cost, RecordError>>,
    cost: Option<Cost>,
}

impl Estimate {
    /// What it costs, once that is known.
    #[must_use]
    pub fn cost(&self) -> Option<Cost> {
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
    mut estimate: ResMut<Estimate>,
    (session, preferences): (Res<Session>, Res<Preferences>),
    places: (Res<CaptureFolder>, Res<Workshop>),
    recorder: Res<Recorder>,
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
        now.job = Order::new(&preferences, &session, (&places.0, &places.1))
            .map(|order| Job::start("an estimate", move |progress| order.tried(progress)));
    }
    if let Some(answer) = Job::take(&mut now.job) {
        // Where it fails, writing the film says why.
        now.cost = answer.ok();
        estimate.set_changed();
    }
}
