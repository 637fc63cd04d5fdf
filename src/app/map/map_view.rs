//! The map of all designs: where each of them is, what lies between them, and the blend under
//! the puck, drawn in place of the stage.
//!
//! The space is built beside the window, and so is what lies on the map; the blend is placed and
//! drawn in the frame in which the puck moves, which goes along where the film is played.

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

/// How far an arrow key moves the puck, of the map's reach.
const STEP: f64 = 0.02;

/// Why there is no map.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct MapBuildError(Arc<ProjectError>);

/// The map in place of the stage.
#[derive(Resource, Debug, Default)]
pub struct MapView {
    /// It is shown.
    pub is_shown: bool,
    /// A click on it sets a stop of the path.
    pub draws_path: bool,
    /// The measure whose contours lie under it.
    pub shown: Option<MapMeasure>,
    /// Where the puck is.
    puck: DVec2,
    /// Where it was since its way is recorded.
    recorded: Option<Vec<DVec2>>,
    /// The t that the film was at last.
    t: Option<f64>,
    /// What the map is of.
    whole: Option<LoadedProject>,
    curve: Option<MapCurve>,
    /// What is being built is a draft.
    is_draft: bool,
    job: Option<BackgroundJob<DesignSpace, MapBuildError>>,
    problem: Option<JobError<MapBuildError>>,
    made: Option<MapPictures>,
    /// From the puck's place to the picture of the blend.
    times: StageTimes,
}

impl MapView {
    /// Where the puck is, y up.
    #[must_use]
    pub fn puck(&self) -> DVec2 {
        self.puck
    }

    /// The map and what is drawn of it.
    #[must_use]
    pub fn made(&self) -> Option<&MapPictures> {
        self.made.as_ref()
    }

    /// The curve of the path over it, if there is one.
    #[must_use]
    pub fn curve(&self) -> Option<&MapCurve> {
        self.curve.as_ref()
    }

    /// Why there is no map.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<MapBuildError>> {
        self.problem.as_ref()
    }

    /// It is being built, or drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some() || self.made.as_ref().is_some_and(MapPictures::is_busy)
    }

    /// The way of the puck is being recorded.
    #[must_use]
    pub fn is_recording(&self) -> bool {
        self.recorded.is_some()
    }

    /// Begins to record the way of the puck, or ends it: then where it was.
    pub fn record(&mut self) -> Option<Vec<DVec2>> {
        if self.recorded.is_none() {
            self.recorded = Some(vec![self.puck]);
            return None;
        }
        self.recorded.take()
    }

    /// What a key means while the map is shown: arrows move the puck, a stop is one of the
    /// path.
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

    /// Moves the puck.
    pub fn move_puck(&mut self, to: DVec2) {
        self.puck = to.clamp(DVec2::splat(-REACH), DVec2::splat(REACH));
        if let Some(recorded) = &mut self.recorded {
            recorded.push(self.puck);
        }
    }

    /// Where the map's designs are to be when one is moved; none where it cannot be there.
    #[must_use]
    pub fn sites_with(&self, design: usize, to: DVec2) -> Option<Vec<DVec2>> {
        let mut sites = self.made.as_ref()?.map().sites().to_vec();
        let site = sites.get_mut(design).filter(|_| to.is_finite())?;
        *site = to.clamp(DVec2::splat(-1.0), DVec2::ONE);
        // Two in one place stay where they were.
        WeightMap::new(&sites).ok().map(|_| sites)
    }

    /// Takes the puck along where the film moves on; whether it did.
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

    /// Builds the space of what is open and has its map drawn; whether something new is there.
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

    /// Draws the blend under the puck, unless it is drawn so already; whether it was.
    pub fn look(&mut self, size: PixelSize, style: TransitionStyle) -> bool {
        let (puck, start) = (self.puck, Instant::now());
        let made = self.made.as_mut();
        let is_new = made.is_some_and(|made| made.look(puck, size, style));
        if is_new {
            self.times.record(start.elapsed());
        }
        is_new
    }

    /// How long the last moves of the puck took, from its place to the picture of the blend.
    #[must_use]
    pub fn times(&self) -> &StageTimes {
        &self.times
    }

    fn place(&mut self, space: DesignSpace) {
        let Some(whole) = &self.whole else {
            return;
        };
        // What was drawn stays until the new one is there.
        let ground = self.made.take().and_then(|made| made.ground().cloned());
        let ground = ground.filter(|ground| ground.count == space.designs().len());
        match whole.map_of(&space) {
            Ok(map) => self.made = Some(MapPictures::new(space, map, ground)),
            Err(error) => self.refuse(JobError::Failed(MapBuildError(Arc::new(error)))),
        }
    }

    /// Takes in what is open as it is now; whether the map is another one.
    fn follow(&mut self, whole: LoadedProject) -> bool {
        let before = self.whole.replace(whole.clone());
        let is_same = before.is_some_and(|before| {
            let same_space = needs_no_other_space(&before.project, &whole.project);
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
        // A draft first, where the best takes longer, so that there is a map at once.
        self.is_draft = whole.project.options.quality != BuildQuality::Draft;
        self.start(whole, self.is_draft.then_some(BuildQuality::Draft));
        true
    }

    fn start(&mut self, whole: LoadedProject, quality: Option<BuildQuality>) {
        self.job = Some(BackgroundJob::start("the map", move |progress| {
            let built = whole.built_space(quality, progress);
            built.map_err(|error| MapBuildError(Arc::new(error)))
        }));
    }

    fn refuse(&mut self, problem: JobError<MapBuildError>) {
        (self.problem, self.made, self.is_draft) = (Some(problem), None, false);
    }

    fn take(&mut self) -> bool {
        match BackgroundJob::take(&mut self.job) {
            None => return false,
            Some(Ok(space)) => {
                self.place(space);
                // Fields and meshes that are given have no draft.
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

/// Whether two projects are of one space: how it is played, painted and laid out makes no other.
fn needs_no_other_space(a: &Project, b: &Project) -> bool {
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
