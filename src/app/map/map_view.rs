//! The map of all designs, shown in place of the stage: every point is a blend, and a marker
//! selects one.
//!
//! The space of blends and its thumbnails are built in the background. Whenever the marker moves,
//! the blend under it is redrawn in the same screen update; during playback the marker follows the
//! film.

use std::sync::Arc;
use std::time::Instant;

use bevy::prelude::Resource;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::{BackgroundJob, JobError};
use crate::app::map::pictures::MapPictures;
use crate::app::map::thumbnails::MAP_HALF_SIDE;
use crate::app::session::state::Session;
use crate::export::PixelSize;
use crate::geometry::DVec2;
use crate::measure::MapMeasure;
use crate::project::{LoadedProject, MapSettings, Project, ProjectError};
use crate::space::{DesignSpace, MapCurve, WeightMap};
use crate::stage::DurationHistory;
use crate::transition::{BuildQuality, Timing, TransitionStyle, segment_at};

/// Distance that an arrow key moves the marker, as a fraction of the map's half side (heuristic).
const MARKER_STEP: f64 = 0.02;

/// Reason why the map could not be built.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct MapBuildError(Arc<ProjectError>);

/// The map view: its marker, its settings, and the background job that builds the map.
#[derive(Resource, Debug, Default)]
pub struct MapView {
    /// Whether the map is shown in place of the stage.
    pub is_shown: bool,
    /// Whether a click on the map adds a stop to the path.
    pub is_drawing_path: bool,
    /// Measure whose contours are shown; `None` shows none.
    pub measure: Option<MapMeasure>,
    /// Position of the marker, y up.
    marker: DVec2,
    /// Positions of the marker since recording started; `None` when not recording.
    recorded: Option<Vec<DVec2>>,
    /// Playback's t at the previous screen update.
    t: Option<f64>,
    /// The project whose designs the map shows.
    loaded: Option<LoadedProject>,
    curve: Option<MapCurve>,
    /// Whether the space being built is a draft.
    is_draft: bool,
    job: Option<BackgroundJob<DesignSpace, MapBuildError>>,
    problem: Option<JobError<MapBuildError>>,
    pictures: Option<MapPictures>,
    /// Times taken to redraw the blend after each move of the marker.
    times: DurationHistory,
}

impl MapView {
    /// Position of the marker, y up.
    #[must_use]
    pub fn marker(&self) -> DVec2 {
        self.marker
    }

    /// The map with its images; `None` until it is built.
    #[must_use]
    pub fn pictures(&self) -> Option<&MapPictures> {
        self.pictures.as_ref()
    }

    /// Curve of the path over the map, if there is one.
    #[must_use]
    pub fn curve(&self) -> Option<&MapCurve> {
        self.curve.as_ref()
    }

    /// Reason why the map could not be built; `None` if there is no problem.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<MapBuildError>> {
        self.problem.as_ref()
    }

    /// Whether the map is being built or drawn. While the map is hidden its images are not
    /// collected, so they do not count.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let is_drawing = self.pictures.as_ref().is_some_and(MapPictures::is_busy);
        self.job.is_some() || (self.is_shown && is_drawing)
    }

    /// Whether the marker's movement is being recorded.
    #[must_use]
    pub fn is_recording(&self) -> bool {
        self.recorded.is_some()
    }

    /// Ends drawing a path, and stops recording one without keeping it; returns `false` if neither
    /// was going on.
    pub fn end_path_tools(&mut self) -> bool {
        let was_drawing = std::mem::take(&mut self.is_drawing_path);
        self.recorded.take().is_some() || was_drawing
    }

    /// Hides the map, and ends drawing and recording.
    pub fn hide(&mut self) {
        (self.is_shown, self.is_drawing_path, self.recorded) = (false, false, None);
    }

    /// Starts recording the marker's movement, or stops and returns the recorded positions.
    pub fn toggle_recording(&mut self) -> Option<Vec<DVec2>> {
        if self.recorded.is_none() {
            self.recorded = Some(vec![self.marker]);
            return None;
        }
        self.recorded.take()
    }

    /// Returns the intent that replaces the usual intent of a key while the map is shown; `None` if
    /// the key keeps its meaning.
    ///
    /// Arrow keys move the marker. The key that adds a stop extends the path; the key of the match
    /// editor turns drawing on or off; the key of the grid starts or ends recording; the key of the
    /// normal speed removes the last stop.
    #[must_use]
    pub fn map_intent(&self, intent: &Intent) -> Option<Intent> {
        let direction = match intent {
            _ if !self.is_shown => return None,
            Intent::Step(n) => DVec2::new(f64::from(*n), 0.0),
            Intent::JumpToNextStop => DVec2::Y,
            Intent::JumpToPreviousStop => DVec2::NEG_Y,
            Intent::AddStop => return Some(Intent::ExtendPath(vec![self.marker])),
            Intent::Editor(EditorAction::Toggle) => {
                return Some(Intent::SetPathDrawing(!self.is_drawing_path));
            }
            Intent::ToggleGrid => return Some(Intent::TogglePathRecording),
            Intent::NormalSpeed if self.is_drawing_path => return Some(Intent::RemoveLastPathStop),
            _ => return None,
        };
        Some(Intent::MoveMarker(
            self.marker + direction * MARKER_STEP * MAP_HALF_SIDE,
        ))
    }

    /// Moves the marker, clamped to the map.
    pub fn move_marker(&mut self, to: DVec2) {
        self.marker = to.clamp(DVec2::splat(-MAP_HALF_SIDE), DVec2::splat(MAP_HALF_SIDE));
        if let Some(recorded) = &mut self.recorded {
            recorded.push(self.marker);
        }
    }

    /// Places of all designs on the map after moving one of them to `to`. `None` if another design
    /// is already there, if `to` is not finite, or if the map is not built yet.
    #[must_use]
    pub fn sites_with(&self, design: usize, to: DVec2) -> Option<Vec<DVec2>> {
        let mut sites = self.pictures.as_ref()?.map().sites().to_vec();
        let site = sites.get_mut(design).filter(|_| to.is_finite())?;
        *site = to.clamp(DVec2::splat(-1.0), DVec2::ONE);
        // `WeightMap::new` fails if two designs lie in the same place.
        WeightMap::new(&sites).ok().map(|_| sites)
    }

    /// Moves the marker along with playback; returns whether it moved.
    pub fn follow_playback(&mut self, t: f64) -> bool {
        let is_new = self.t.replace(t).is_some_and(|previous| previous != t);
        if !(is_new && self.is_shown) {
            return false;
        }
        let to = match (&self.curve, &self.pictures, &self.loaded) {
            (Some(curve), ..) => Some(curve.at(t)),
            (None, Some(pictures), Some(loaded)) => {
                let (segment, within) = segment_at(loaded.project.pair_count(), t);
                let [from, to] = loaded.project.pair_designs(segment);
                let sites = pictures.map().sites();
                let ends = sites.get(from).zip(sites.get(to));
                ends.map(|(from, to)| from.lerp(*to, within))
            }
            _ => None,
        };
        to.into_iter().for_each(|to| self.move_marker(to));
        to.is_some()
    }

    /// Builds the map of the open project and its images; returns whether the map or an image is
    /// new.
    pub fn update(&mut self, session: &Session, is_new: bool) -> bool {
        let mut is_changed = self.collect_space();
        if !self.is_shown {
            return is_changed;
        }
        if is_new && session.work().is_none() {
            match session.loaded_project() {
                Some(loaded) => is_changed |= self.adopt_project(loaded),
                None => {
                    (self.pictures, self.loaded, self.curve) = (None, None, None);
                    (self.job, self.is_draft) = (None, false);
                }
            }
        }
        if let (Some(pictures), Some(loaded)) = (&mut self.pictures, &self.loaded) {
            let is_final = self.job.is_none();
            let saved_places = &loaded.project.map.kept;
            is_changed |= pictures.update(session.style(), saved_places, self.measure, is_final);
        }
        is_changed
    }

    /// Draws the blend under the marker unless the current image shows it; returns whether it drew.
    pub fn draw_blend(&mut self, size: PixelSize, style: TransitionStyle) -> bool {
        let (marker, start) = (self.marker, Instant::now());
        let pictures = self.pictures.as_mut();
        let is_new = pictures.is_some_and(|pictures| pictures.draw_blend(marker, size, style));
        if is_new {
            self.times.record(start.elapsed());
        }
        is_new
    }

    /// Times taken to redraw the blend after each of the last moves of the marker.
    #[must_use]
    pub fn draw_times(&self) -> &DurationHistory {
        &self.times
    }

    /// Takes a newly built space of blends and lays out its map.
    fn adopt_space(&mut self, space: DesignSpace) {
        let Some(loaded) = &self.loaded else {
            return;
        };
        // The old thumbnails stay until the new ones are drawn.
        let thumbnails = self
            .pictures
            .take()
            .and_then(|pictures| pictures.thumbnails().cloned());
        let thumbnails = thumbnails.filter(|thumbnails| thumbnails.count == space.designs().len());
        match loaded.map_of(&space) {
            Ok(map) => self.pictures = Some(MapPictures::new(space, map, thumbnails)),
            Err(error) => self.fail(JobError::Failed(MapBuildError(Arc::new(error)))),
        }
    }

    /// Switches to the project's current settings; returns whether anything on the map is new.
    fn adopt_project(&mut self, loaded: LoadedProject) -> bool {
        let before = self.loaded.replace(loaded.clone());
        let has_same_settings = before
            .as_ref()
            .is_some_and(|before| before.project == loaded.project);
        let is_same = before.is_some_and(|before| {
            let same_space = have_same_space(&before.project, &loaded.project);
            let designs = before.designs.iter().zip(&loaded.designs);
            same_space && designs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
        });
        self.curve = MapCurve::new(&loaded.project.map.path);
        if is_same && self.problem.is_none() {
            if let Some(pictures) = &self.pictures {
                let is_elsewhere = loaded
                    .map_of(pictures.space())
                    .is_ok_and(|map| map.sites() != pictures.map().sites());
                if is_elsewhere {
                    self.adopt_space(pictures.space().clone());
                    return true;
                }
            }
            return !has_same_settings;
        }
        self.problem = None;
        // A draft is built first, so that a map appears at once.
        self.is_draft = loaded.project.options.quality != BuildQuality::Draft;
        self.start(loaded, self.is_draft.then_some(BuildQuality::Draft));
        true
    }

    /// Starts building the space of blends in this quality; `None` uses the project's own quality.
    fn start(&mut self, loaded: LoadedProject, quality: Option<BuildQuality>) {
        self.job = Some(BackgroundJob::start("the map", move |progress| {
            let built = loaded.build_space(quality, progress);
            built.map_err(|error| MapBuildError(Arc::new(error)))
        }));
    }

    /// Removes the map and stores the problem that prevents it from being built.
    fn fail(&mut self, problem: JobError<MapBuildError>) {
        (self.problem, self.pictures, self.is_draft) = (Some(problem), None, false);
    }

    /// Collects the result of building the space, and starts the final build after a draft; returns
    /// whether there was a result.
    fn collect_space(&mut self) -> bool {
        match BackgroundJob::take_result(&mut self.job) {
            None => return false,
            Some(Ok(space)) => {
                self.adopt_space(space);
                // Spaces of distance fields and of given meshes have no draft, so their first build
                // is final.
                let is_matched = self.pictures.as_ref().is_some_and(MapPictures::is_matched);
                let is_draft = std::mem::take(&mut self.is_draft);
                if let Some(loaded) = self.loaded.clone().filter(|_| is_draft && is_matched) {
                    self.start(loaded, None);
                }
            }
            Some(Err(problem)) => self.fail(problem),
        }
        true
    }
}

/// Whether two projects have the same space of blends; timing, colours and the layout of the map do
/// not affect it.
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
