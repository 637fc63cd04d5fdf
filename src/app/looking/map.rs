//! The map of all designs: where each of them is, what lies between them, and the blend under
//! the puck, drawn in place of the stage.
//!
//! The space is built beside the window, and so is what lies on the map; the blend is placed and
//! drawn in the frame in which the puck moves. Nothing of the project is changed.

use std::sync::Arc;

use bevy::prelude::{MessageReader, ResMut, Resource};
use image::RgbaImage;

use crate::app::asking::intent::Intent;
use crate::app::session::state::Session;
use crate::app::telling::job::{Job, JobError};
use crate::colour::Rgb;
use crate::design::Form;
use crate::export::{Drawing, PixelSize, SizeError, View, rasterise};
use crate::geometry::{Bounds, DVec2};
use crate::mesh::SitesError;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::space::{Map, MapLayout, Space, SpaceError, SpaceFrame, SpaceSpec};
use crate::transition::{Quality, Style};

/// How far the map reaches from its middle: sites are within 1 of it.
pub const REACH: f64 = 1.2;

/// Small pictures along each side of the map.
const CELLS: u32 = 9;

/// Pixels along each side of the picture of what lies between the designs.
const SIDE_PX: u32 = 1056;

/// How much of a design's picture on the map is wider than that of a blend.
const DESIGN: f64 = 1.3;

/// How far an arrow key moves the puck, of the map's reach.
const STEP: f64 = 0.02;

/// Why there is no map.
#[derive(Clone, Debug, thiserror::Error)]
pub enum MapProblem {
    /// The designs cannot be laid into one frame, or are not blended so.
    #[error("{0}")]
    Project(Arc<ProjectError>),
    /// They span no space.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// They have no sites.
    #[error(transparent)]
    Sites(#[from] SitesError),
}

/// The map in place of the stage.
#[derive(Resource, Debug, Default)]
pub struct MapView {
    /// It is shown.
    pub is_shown: bool,
    /// How the designs are laid out.
    pub layout: MapLayout,
    /// Where the puck is.
    puck: DVec2,
    /// What was built, or tried.
    settings: Option<Project>,
    /// What the best is to be built from, while its draft is.
    better: Option<SpaceSpec>,
    job: Option<Job<Space, MapProblem>>,
    problem: Option<JobError<MapProblem>>,
    made: Option<Made>,
}

/// A space with its map, and what is drawn of them.
#[derive(Debug)]
pub struct Made {
    space: Space,
    map: Map,
    frame: SpaceFrame,
    /// What lies between the designs, and the designs.
    ground: Option<Ground>,
    drawing: Option<Job<Ground, SizeError>>,
    /// How that is drawn.
    style: Option<Style>,
    /// The blend under the puck.
    blend: Option<Blend>,
}

/// Pictures of the whole map, from −[`REACH`] to [`REACH`]; straight alpha on a transparent ground.
#[derive(Clone, Debug)]
pub struct Ground {
    /// What lies between the designs.
    pub between: Arc<RgbaImage>,
    /// The designs.
    pub designs: Arc<RgbaImage>,
}

/// The blend as it was drawn last.
#[derive(Debug)]
struct Blend {
    of: (Vec<f64>, PixelSize, Style),
    picture: Arc<RgbaImage>,
}

impl Made {
    fn new(space: Space, sites: &[DVec2]) -> Result<Self, SitesError> {
        Ok(Self {
            map: Map::new(sites)?,
            frame: space.frame(),
            space,
            ground: None,
            drawing: None,
            style: None,
            blend: None,
        })
    }

    /// The space.
    #[must_use]
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &Map {
        &self.map
    }

    /// The weights under the puck.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        self.frame.weights()
    }

    /// What lies on the map, once it was drawn.
    #[must_use]
    pub fn ground(&self) -> Option<&Ground> {
        self.ground.as_ref()
    }

    /// The blend under the puck.
    #[must_use]
    pub fn blend(&self) -> Option<&Arc<RgbaImage>> {
        self.blend.as_ref().map(|blend| &blend.picture)
    }

    /// Whether its outlines were matched for it.
    fn is_matched(&self) -> bool {
        let designs = self.space.designs().iter();
        let mut forms = designs.map(|design| &design.form);
        self.space.family().is_some() && forms.any(|form| matches!(form, Form::Outline(_)))
    }

    /// The blend under the puck, over a ground or none.
    #[must_use]
    pub fn drawing(&self, size: PixelSize, style: &Style, ground: Option<Rgb>) -> Drawing {
        let bounds = self.space.bounds();
        let view = View::fit(bounds.padded(0.04 * bounds.diameter()), size);
        let mut drawing = Drawing::new(size, ground);
        let tint = self.space.tint(self.frame.weights());
        drawing.push_figure(&self.frame.figure(), tint, style, &view);
        drawing
    }

    /// Draws the blend at a place, unless it is drawn so already; whether it was.
    fn look(&mut self, puck: DVec2, size: PixelSize, style: Style) -> bool {
        let mut weights = vec![0.0; self.space.designs().len()];
        self.map.weights(puck, &mut weights);
        let of = (weights, size, style);
        if self.blend.as_ref().is_some_and(|blend| blend.of == of) {
            return false;
        }
        self.frame.seek(&of.0);
        let picture = Arc::new(rasterise(&self.drawing(size, &style, None)));
        self.blend = Some(Blend { of, picture });
        true
    }

    /// Has the map drawn, where it is not drawn so; whether something new is there.
    fn paint(&mut self, style: Style) -> bool {
        if let Some(answer) = Job::take(&mut self.drawing) {
            // What cannot be drawn is not shown: the sites and the puck are.
            self.ground = answer.ok();
            return true;
        }
        if self.style == Some(style) {
            return false;
        }
        self.style = Some(style);
        let (space, map) = (self.space.clone(), self.map.clone());
        self.drawing = Some(Job::start("the map", move |_| ground(&space, &map, &style)));
        false
    }
}

impl MapView {
    /// Where the puck is, y up.
    #[must_use]
    pub fn puck(&self) -> DVec2 {
        self.puck
    }

    /// The map and what is drawn of it.
    #[must_use]
    pub fn made(&self) -> Option<&Made> {
        self.made.as_ref()
    }

    /// Why there is none.
    #[must_use]
    pub fn problem(&self) -> Option<&JobError<MapProblem>> {
        self.problem.as_ref()
    }

    /// It is being built, or drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let drawing = self
            .made
            .as_ref()
            .is_some_and(|made| made.drawing.is_some());
        self.job.is_some() || drawing
    }

    /// What a key means while the map is shown: arrows move the puck.
    #[must_use]
    pub fn instead(&self, intent: &Intent) -> Option<Intent> {
        let by = match intent {
            _ if !self.is_shown => return None,
            Intent::Step(n) => DVec2::new(f64::from(*n), 0.0),
            Intent::JumpToNextStop => DVec2::Y,
            Intent::JumpToPreviousStop => DVec2::NEG_Y,
            _ => return None,
        };
        Some(Intent::Puck(self.puck + by * STEP * REACH))
    }

    /// Builds the space of what is open and has its map drawn; whether something new is there.
    pub fn work(&mut self, session: &Session, is_new: bool) -> bool {
        let mut is_changed = self.take();
        if !self.is_shown {
            return is_changed;
        }
        if is_new && session.work().is_none() {
            match session.whole_loaded() {
                Some(whole) => self.follow(whole),
                None => {
                    (self.made, self.settings) = (None, None);
                    (self.job, self.better) = (None, None);
                }
            }
        }
        if let Some(made) = &mut self.made {
            is_changed |= made.paint(session.style());
        }
        is_changed
    }

    /// Draws the blend under the puck, unless it is drawn so already; whether it was.
    pub fn look(&mut self, size: PixelSize, style: Style) -> bool {
        let puck = self.puck;
        let made = self.made.as_mut();
        made.is_some_and(|made| made.look(puck, size, style))
    }

    fn lay(&mut self) {
        let Some(made) = self.made.take() else {
            return;
        };
        let sites = self.layout.sites(made.space.likeness());
        self.place(made.space, &sites);
    }

    fn place(&mut self, space: Space, sites: &[DVec2]) {
        // What was drawn for the draft stays until that of the best is there.
        let before = self.made.take();
        let before = before.filter(|made| made.map.sites() == sites);
        let ground = before.and_then(|made| made.ground);
        match Made::new(space, sites) {
            Ok(made) => self.made = Some(Made { ground, ..made }),
            Err(error) => self.refuse(JobError::Failed(error.into())),
        }
    }

    /// Moves a design elsewhere; two in one place stay where they were.
    fn move_site(&mut self, design: usize, to: DVec2) {
        let Some(made) = &self.made else {
            return;
        };
        let mut sites = made.map.sites().to_vec();
        if let Some(site) = sites.get_mut(design)
            && to.is_finite()
        {
            *site = to.clamp(DVec2::splat(-1.0), DVec2::ONE);
            if let Ok(again) = Made::new(made.space.clone(), &sites) {
                // What was drawn stays until the new one is there.
                let ground = made.ground.clone();
                self.made = Some(Made { ground, ..again });
            }
        }
    }

    fn follow(&mut self, whole: LoadedProject) {
        let settings = Some(&whole.project);
        if self.settings.as_ref() == settings {
            return;
        }
        // How it is played and painted makes no other space.
        let is_same = self.settings.as_ref().is_some_and(|before| {
            let as_before = Project {
                timing: before.timing,
                stops: before.stops.clone(),
                style: before.style,
                ..whole.project.clone()
            };
            as_before == *before
        });
        self.settings = settings.cloned();
        if is_same && self.problem.is_none() {
            return;
        }
        self.problem = None;
        match whole.space() {
            Ok(spec) => self.build(spec),
            Err(error) => {
                self.job = None;
                self.refuse(JobError::Failed(MapProblem::Project(Arc::new(error))));
            }
        }
    }

    /// Builds a draft first, where the best takes longer, so that there is a map at once.
    fn build(&mut self, mut spec: SpaceSpec) {
        self.better = None;
        if spec.options.quality != Quality::Draft {
            self.better = Some(spec.clone());
            spec.options.quality = Quality::Draft;
        }
        self.start(spec);
    }

    fn start(&mut self, spec: SpaceSpec) {
        self.job = Some(Job::start("the map", move |progress| {
            Ok(Space::build(&spec, progress)?)
        }));
    }

    fn refuse(&mut self, problem: JobError<MapProblem>) {
        (self.problem, self.made, self.better) = (Some(problem), None, None);
    }

    fn take(&mut self) -> bool {
        match Job::take(&mut self.job) {
            None => return false,
            Some(Ok(space)) => {
                let sites = match &self.made {
                    // Where somebody has put them.
                    Some(made) if self.better.is_none() => made.map.sites().to_vec(),
                    _ => self.layout.sites(space.likeness()),
                };
                // Of other designs there may be another number.
                let sites = match sites.len() == space.designs().len() {
                    true => sites,
                    false => self.layout.sites(space.likeness()),
                };
                self.place(space, &sites);
                // Fields and meshes that are given have no draft.
                let is_matched = self.made.as_ref().is_some_and(Made::is_matched);
                if let Some(spec) = self.better.take().filter(|_| is_matched) {
                    self.start(spec);
                }
            }
            Some(Err(problem)) => self.refuse(problem),
        }
        true
    }
}

/// Draws what lies between the designs, and the designs.
fn ground(space: &Space, map: &Map, style: &Style) -> Result<Ground, SizeError> {
    let size = PixelSize::new(SIDE_PX, SIDE_PX)?;
    let cell = 2.0 * REACH / f64::from(CELLS);
    let px = f64::from(SIDE_PX) / (2.0 * REACH);
    let mut frame = space.frame();
    let mut weights = vec![0.0; space.designs().len()];
    let mut picture = |places: &[DVec2], wide: f64| {
        let mut drawing = Drawing::new(size, None);
        for &place in places {
            map.weights(place, &mut weights);
            frame.seek(&weights);
            let side = DVec2::splat(0.86 * wide * cell * px);
            let middle = DVec2::new(place.x + REACH, REACH - place.y) * px;
            let seen = square(space.bounds());
            let view = View::fit_cell(seen, size, middle - 0.5 * side, side);
            drawing.push_figure(&frame.figure(), space.tint(&weights), style, &view);
        }
        Arc::new(rasterise(&drawing))
    };
    let steps = (0..CELLS * CELLS).map(|at| {
        let [column, row] = [at % CELLS, at / CELLS].map(|k| (f64::from(k) + 0.5) * cell - REACH);
        DVec2::new(column, row)
    });
    // None under a design's picture, or its name below that.
    let is_free = |place: &DVec2| {
        map.sites().iter().all(|site| {
            let [across, below] = [(place.x - site.x).abs(), site.y - place.y];
            across > 0.9 * cell || !(-0.9 * cell..1.3 * cell).contains(&below)
        })
    };
    let between = steps.filter(|place| map.holds(*place, 0.3 * cell));
    let between: Vec<DVec2> = between.filter(is_free).collect();
    Ok(Ground {
        between: picture(&between, 1.0),
        designs: picture(map.sites(), DESIGN),
    })
}

/// The square around a box.
fn square(bounds: Bounds) -> Bounds {
    let half = DVec2::splat(0.5 * bounds.size().max_element());
    Bounds {
        min: bounds.centre() - half,
        max: bounds.centre() + half,
    }
}

/// Acts on the intents that concern the map.
pub fn apply(mut intents: MessageReader<Intent>, mut view: ResMut<MapView>) {
    for intent in intents.read() {
        match intent {
            Intent::ToggleMap => view.is_shown = !view.is_shown,
            Intent::LayOut(layout) => {
                view.layout = *layout;
                view.lay();
            }
            Intent::Puck(to) if to.is_finite() => {
                view.puck = to.clamp(DVec2::splat(-REACH), DVec2::splat(REACH));
            }
            Intent::MoveSite(design, to) => view.move_site(*design, *to),
            _ => {}
        }
    }
}
