//! The film strips of the gallery, drawn one after the other beside the window.

use std::collections::{HashMap, VecDeque};

use bevy::prelude::{DetectChangesMut, FromWorld, Res, ResMut, Resource, World};
use image::RgbaImage;

use crate::app::opening::apply::Gallery;
use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::export::{Drawing, PixelSize, SizeError, View, even_times, framing, rasterise};
use crate::geometry::DVec2;
use crate::progress::Progress;
use crate::project::gallery;
use crate::transition::{Transition, TransitionSpec};

/// Width and height of a strip in pixels: twice what is shown at scale factor 1.
pub const STRIP_PX: (u32, u32) = (384, 128);

/// How many in-betweens a strip shows.
const FRAMES: usize = 3;

/// A strip, or that there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum Thumbnail {
    /// Straight alpha, transparent ground.
    Ready(RgbaImage),
    /// The project cannot be shown; opening it tells why.
    Failed,
}

/// All strips that there are yet.
#[derive(Resource, Debug)]
pub struct Thumbnails {
    waiting: VecDeque<String>,
    running: Option<(String, Job<Option<RgbaImage>>)>,
    done: HashMap<String, Thumbnail>,
}

impl FromWorld for Thumbnails {
    fn from_world(world: &mut World) -> Self {
        let entries = &world.resource::<Gallery>().0;
        let waiting = entries.iter().map(|entry| entry.name.clone()).collect();
        Self {
            waiting,
            running: None,
            done: HashMap::new(),
        }
    }
}

impl Thumbnails {
    /// A strip is being drawn, or waits to be.
    pub fn is_busy(&self) -> bool {
        self.running.is_some() || !self.waiting.is_empty()
    }

    /// The strip of a bundled project, once it is there.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Thumbnail> {
        self.done.get(name)
    }
}

/// Takes in a strip that is done and starts the next, while nothing more urgent is going on.
pub fn advance(session: Res<Session>, mut thumbnails: ResMut<Thumbnails>) {
    let thumbnails = thumbnails.bypass_change_detection();
    if let Some((name, answer)) = thumbnails
        .running
        .as_ref()
        .and_then(|(n, job)| Some((n.clone(), job.poll()?)))
    {
        let image = answer.ok().flatten();
        thumbnails
            .done
            .insert(name, image.map_or(Thumbnail::Failed, Thumbnail::Ready));
        thumbnails.running = None;
    }
    if thumbnails.running.is_none()
        && session.work().is_none()
        && let Some(name) = thumbnails.waiting.pop_front()
    {
        let of = name.clone();
        let job = Job::start("a thumbnail", move |progress| strip(&of, progress).ok());
        thumbnails.running = Some((name, job));
    }
}

/// Why a strip cannot be had; never shown, opening the project tells the same.
type StripError = Box<dyn std::error::Error>;

fn strip(name: &str, progress: &dyn Progress) -> Result<RgbaImage, StripError> {
    let loaded = gallery::load(name)?;
    let spec: TransitionSpec = loaded.spec()?;
    let transition = Transition::build(&spec, progress)?;
    let timing = loaded.project.timing;
    Ok(draw(
        &transition,
        &loaded.project.style,
        (timing.from, timing.to),
    )?)
}

fn draw(
    transition: &Transition,
    style: &crate::transition::Style,
    (from, to): (f64, f64),
) -> Result<RgbaImage, SizeError> {
    let size = PixelSize::new(STRIP_PX.0, STRIP_PX.1)?;
    let times = even_times(from, to, FRAMES);
    let bounds = framing(transition, &times);
    let cell = DVec2::new(f64::from(STRIP_PX.0) / FRAMES as f64, f64::from(STRIP_PX.1));
    let mut drawing = Drawing::new(size, None);
    let mut frame = transition.frame(from);
    for (index, t) in times.into_iter().enumerate() {
        frame.seek(t);
        let corner = DVec2::new(index as f64 * cell.x, 0.0);
        drawing.push_frame(&frame, style, &View::fit_cell(bounds, size, corner, cell));
    }
    Ok(rasterise(&drawing))
}
