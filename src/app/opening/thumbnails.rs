//! The film strips of the gallery, drawn one after the other beside the window.

use std::collections::{HashMap, VecDeque};

use bevy::prelude::{DetectChangesMut, FromWorld, Res, ResMut, Resource, World};
use image::RgbaImage;

use crate::app::looking::filmstrip::row;
use crate::app::opening::apply::Gallery;
use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::colour::Rgb;
use crate::export::even_times;
use crate::progress::Progress;
use crate::project::gallery;
use crate::transition::{Sequence, Transition};

/// Width and height of a strip in pixels: twice what is shown at scale factor 1.
pub const STRIP_PX: (u32, u32) = (384, 128);

/// How many forms a strip shows: both ends, and what is between them.
const FRAMES: usize = 3;

/// The most of them: more are too small.
const MOST_FRAMES: usize = 5;

/// All strips that there are yet.
#[derive(Resource, Debug)]
pub struct Thumbnails {
    waiting: VecDeque<String>,
    running: Option<Job<(String, RgbaImage), StripError>>,
    done: HashMap<String, RgbaImage>,
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

    /// The strip of a bundled project, once it is there: straight alpha, and a transparent ground
    /// but for what has its own paint.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&RgbaImage> {
        self.done.get(name)
    }
}

/// Takes in a strip that is done and starts the next, while nothing more urgent is going on.
pub fn advance(session: Res<Session>, mut thumbnails: ResMut<Thumbnails>) {
    // Looked at in each frame; nobody asks whether it has changed.
    let thumbnails = thumbnails.bypass_change_detection();
    // A project that cannot be shown has no strip; opening it tells why.
    if let Some(Ok((name, strip))) = Job::take(&mut thumbnails.running) {
        thumbnails.done.insert(name, strip);
    }
    if thumbnails.running.is_none()
        && session.work().is_none()
        && let Some(name) = thumbnails.waiting.pop_front()
    {
        thumbnails.running = Some(Job::start("a thumbnail", move |progress| {
            let strip = strip(&name, progress)?;
            Ok((name, strip))
        }));
    }
}

/// Why a strip cannot be had; never shown, opening the project tells the same.
type StripError = Box<dyn std::error::Error + Send + Sync>;

fn strip(name: &str, progress: &dyn Progress) -> Result<RgbaImage, StripError> {
    let loaded = gallery::load(name)?;
    let legs = loaded.legs();
    let built = legs.iter().map(|leg| Ok(leg.build(progress)?));
    let built: Vec<Transition> = built.collect::<Result<_, StripError>>()?;
    let sequence = Sequence::new(built).ok_or("a project has a leg")?;
    let sequence = sequence.leading_back(loaded.project.leads_back());
    let timing = loaded.project.timing;
    // Of many designs some of them, and nothing between.
    let frames = if legs.len() > 1 {
        legs.len() + 1
    } else {
        FRAMES
    };
    let frames = frames.min(MOST_FRAMES);
    let times = even_times(timing.from, timing.to, frames);
    let cell = (STRIP_PX.0 / frames as u32, STRIP_PX.1);
    let style = &loaded.project.style;
    let drawn = row(&sequence, style, &times, cell)?;
    // What has its own paint was drawn for paper: navy letters are lost on a dark window.
    if loaded.designs.iter().all(|design| design.coats.is_empty()) {
        return Ok(drawn);
    }
    let Rgb([r, g, b]) = style.ground;
    let mut paper = RgbaImage::from_pixel(STRIP_PX.0, STRIP_PX.1, image::Rgba([r, g, b, 255]));
    image::imageops::overlay(&mut paper, &drawn, 0, 0);
    Ok(paper)
}
