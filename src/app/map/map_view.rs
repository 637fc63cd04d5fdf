//! The map of all designs, shown in place of the stage: every point is a blend, and a marker
//! selects one.
//!
//! The space of blends and its thumbnails are built in the background. The blend under the marker
//! is drawn in the frame in which the marker moves; during playback the marker follows the film.

use std::sync::Arc;
use std::time::Instant;

use bevy::prelude::Resource;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::map::pictures::MapPictures;
use crate::app::map::thumbnails::REACH;
use crate::app::session::state::Session;
use crate::export::PixelSize;
use crate::geometry::DVec2;
use crate::measure::MapMeasure;
use crate::project::{LoadedProject, MapSettings, Project, ProjectError};
use crate::space::{DesignSpace, MapCurve, WeightMap};
use crate::stage::StageTimes;
use crate::transition::{BuildQuality, Timing, TransitionStyle, segment_at};

/// Distance that an arrow key moves the marker, as a fraction of the map's half side (heuristic).
const STEP: f64 = 0.02;

/// Why the map could not be built.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct MapBuildError(Arc<ProjectError>);

/// State of the map view.
#[derive(Resource, Debug, Default)]
pub struct MapView {
    /// Whether the map is shown in place of the stage.
    pub is_shown: bool,
    /// Whether a click on the map adds a stop to the path.
    pub draws_path: bool,
    /// Measure whose contours are shown.
    pub shown: Option<MapMeasure>,
    /// Position of the marker, y up.
    puck: DVec2,
    /// Positions of the marker since recording started; `None` when not recording.
    recorded: Option<Vec<DVec2>>,
    /// Playback position in the previous frame.
    t: Option<f64>,
    /// The project that the map shows.
    whole: Option<LoadedProject>,
    curve: Option<MapCurve>,
    /// Whether the space being built is a draft.
    is_draft: bool,
    job: Option<BackgroundJob<DesignSpace, MapBuildError>>,
    problem: Option<JobError<MapBuildError>>,
    made: Option<MapPictures>,
    /// Durations from a move of the marker to the new image of the blend.
    times: StageTimes,
}

impl MapView {
    /// Position of the marker, y up.
    #[must_use]
    pub fn puck(&self) -> DVec2 {
        self.puck
    }

    /// The map with its images; `None` until it is built.
    #[must_use]
    pub fn made(&self) -> Option<&MapPictures> {
        self.made.as_ref()
    }

    /// Curve of the path over the map, if there is one.
    #[must_use]
    pub fn curve(&self) -> Option<&MapCurve> {
        self.curve.as_ref()
    }

    /// Why the map could not be built.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<MapBuildError>> {
        self.problem.as_ref()
    }

    /// Whether the map is being built or drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some() || self.made.as_ref().is_some_and(MapPictures::is_busy)
    }

    /// Whether the marker's movement is being recorded.
    #[must_use]
    pub fn is_recording(&self) -> bool {
        self.recorded.is_some()
    }

    /// Starts recording the marker's movement, or stops and returns the recorded positions.
    pub fn record(&mut self) -> Option<Vec<DVec2>> {
        if self.recorded.is_none() {
            self.recorded = Some(vec![self.puck]);
            return None;
        }
        self.recorded.take()
    }

    /// Replacement for the intent of a key while the map is shown: arrow keys move the marker, and
    /// the stop key adds a stop to the path.
    #[must_use]
    pub fn instead(&self, intent: &Intent) -> Option<Intent> {
        let by = match intent {
            _ if !self.is_shown => return None,
            Intent::Step(n) => DVec2::new(f64::from(*n), 0.0),
            Intent::JumpToNextStop => DVec2::Y,
            Intent::JumpToPreviousStop => DVec2::NEG_Y,
            Intent::AddStop => return Some(Intent::ExtendPath(vec![self.puck])),
            Intent::Editor(EditorAction::Toggle) => {
                return Some(Intent::DrawPath(!self.draws_path));
            }
            Intent::ToggleGrid => return Some(Intent::RecordPath),
            Intent::NormalSpeed if self.draws_path => return Some(Intent::ShortenPath),
            _ => return None,
        };
        Some(Intent::Puck(self.puck + by * STEP * REACH))
    }

    /// Moves the marker, clamped to the map.
    pub fn move_puck(&mut self, to: DVec2) {
        self.puck = to.clamp(DVec2::splat(-REACH), DVec2::splat(REACH));
        if let Some(recorded) = &mut self.recorded {
            recorded.push(self.puck);
        }
    }

    /// Places of all designs after moving one of them; `None` if it cannot be there.
    #[must_use]
    pub fn sites_with(&self, design: usize, to: DVec2) -> Option<Vec<DVec2>> {
        let mut sites = self.made.as_ref()?.map().sites().to_vec();
        let site = sites.get_mut(design).filter(|_| to.is_finite())?;
        *site = to.clamp(DVec2::splat(-1.0), DVec2::ONE);
        // Two designs in one place are refused.
        WeightMap::new(&sites).ok().map(|_| sites)
    }

    /// Moves the marker along with playback; returns whether it moved.
    pub fn go_with(&mut self, t: f64) -> bool {
        let is_new = self.t.replace(t).is_some_and(|before| before != t);
        if !(is_new && self.is_shown) {
            return false;
        }
        let to = match (&self.curve, &self.made, &self.whole) {
            (Some(curve), ..) => Some(curve.at(t)),
            (None, Some(made), Some(whole)) => {
                let (leg, within) = segment_at(whole.project.pair_count(), t);
                let [from, to] = whole.project.pair_designs(leg);
                let sites = made.map().sites();
                let ends = sites.get(from).zip(sites.get(to));
                ends.map(|(from, to)| from.lerp(*to, within))
            }
            _ => None,
        };
        to.into_iter().for_each(|to| self.move_puck(to));
        to.is_some()
    }

    /// Builds the map of the open project and its images; returns whether something is new.
    pub fn work(&mut self, session: &Session, is_new: bool) -> bool {
        let mut is_changed = self.take();
        if !self.is_shown {
            return is_changed;
        }
        if is_new && session.work().is_none() {
            match session.whole_loaded() {
                Some(whole) => is_changed |= self.follow(whole),
                None => {
                    (self.made, self.whole, self.curve) = (None, None, None);
                    (self.job, self.is_draft) = (None, false);
                }
            }
        }
        if let (Some(made), Some(whole)) = (&mut self.made, &self.whole) {
            let is_final = self.job.is_none();
            let kept = &whole.project.map.kept;
            is_changed |= made.work(session.style(), kept, self.shown, is_final);
        }
        is_changed
    }

    /// Draws the blend under the marker unless the current image shows it; returns whether it drew.
    pub fn look(&mut self, size: PixelSize, style: TransitionStyle) -> bool {
        let (puck, start) = (self.puck, Instant::now());
        let made = self.made.as_mut();
        let is_new = made.is_some_and(|made| made.look(puck, size, style));
        if is_new {
            self.times.record(start.elapsed());
        }
        is_new
    }

    /// Durations of the last moves of the marker, up to the new image of the blend.
    #[must_use]
    pub fn times(&self) -> &StageTimes {
        &self.times
    }

    /// Adopts a newly built space and lays out its map.
    fn place(&mut self, space: DesignSpace) {
        let Some(whole) = &self.whole else {
            return;
        };
        // The old thumbnails stay until the new ones are drawn.
        let ground = self.made.take().and_then(|made| made.ground().cloned());
        let ground = ground.filter(|ground| ground.count == space.designs().len());
        match whole.map_of(&space) {
            Ok(map) => self.made = Some(MapPictures::new(space, map, ground)),
            Err(error) => self.refuse(JobError::Failed(MapBuildError(Arc::new(error)))),
        }
    }

    /// Adopts the project's current settings; returns whether the map changes.
    fn follow(&mut self, whole: LoadedProject) -> bool {
        let before = self.whole.replace(whole.clone());
        let is_same = before.is_some_and(|before| {
            let same_space = have_same_space(&before.project, &whole.project);
            let designs = before.designs.iter().zip(&whole.designs);
            same_space && designs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
        });
        self.curve = MapCurve::new(&whole.project.map.path);
        if is_same && self.problem.is_none() {
            if let Some(made) = &self.made {
                let is_elsewhere = whole
                    .map_of(made.space())
                    .is_ok_and(|map| map.sites() != made.map().sites());
                if is_elsewhere {
                    self.place(made.space().clone());
                }
            }
            return true;
        }
        self.problem = None;
        // A draft first, so that a map appears at once.
        self.is_draft = whole.project.options.quality != BuildQuality::Draft;
        self.start(whole, self.is_draft.then_some(BuildQuality::Draft));
        true
    }

    /// Starts building the space, as a draft or in the project's own quality.
    fn start(&mut self, whole: LoadedProject, quality: Option<BuildQuality>) {
        self.job = Some(BackgroundJob::start("the map", move |progress| {
            let built = whole.built_space(quality, progress);
            built.map_err(|error| MapBuildError(Arc::new(error)))
        }));
    }

    /// Replaces the map by the reason why there is none.
    fn refuse(&mut self, problem: JobError<MapBuildError>) {
        (self.problem, self.made, self.is_draft) = (Some(problem), None, false);
    }

    /// Collects a space that was built; returns whether there was a result.
    fn take(&mut self) -> bool {
        match BackgroundJob::take(&mut self.job) {
            None => return false,
            Some(Ok(space)) => {
                self.place(space);
                // Spaces of fields and of given meshes have no draft.
                let is_matched = self.made.as_ref().is_some_and(MapPictures::is_matched);
                let is_draft = std::mem::take(&mut self.is_draft);
                if let Some(whole) = self.whole.clone().filter(|_| is_draft && is_matched) {
                    self.start(whole, None);
                }
            }
            Some(Err(problem)) => self.refuse(problem),
        }
        true
    }
}

/// Whether two projects have the same space; timing, colours and layout do not affect it.
fn have_same_space(a: &Project, b: &Project) -> bool {
    let bare = |project: &Project| Project {
        title: String::new(),
        description: String::new(),
        timing: Timing::default(),
        stops: Vec::new(),
        style: TransitionStyle::default(),
        map: MapSettings::default(),
        legs: Vec::new(),
        ..project.clone()
    };
    bare(a) == bare(b)
}
