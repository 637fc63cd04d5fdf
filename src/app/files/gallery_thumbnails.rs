//! The film strips of the gallery, drawn one after the other beside the window.

use std::collections::{HashMap, VecDeque};

use bevy::prelude::{DetectChangesMut, FromWorld, Res, ResMut, Resource, World};
use image::RgbaImage;

use crate::app::files::project_actions::GalleryEntries;
use crate::app::jobs::job::BackgroundJob;
use crate::app::persistence::gallery_strips::GalleryStripCache;
use crate::app::session::state::Session;
use crate::app::view::filmstrip::draw_strip;
use crate::colour::Rgb;
use crate::export::even_times;
use crate::project::gallery;
use crate::transition::{Sequence, Transition};
use crate::work::progress::Progress;

/// Width and height of a strip in pixels: twice what is shown at scale factor 1.
pub const STRIP_PX: (u32, u32) = (384, 128);

/// How many forms a strip shows: both ends, and what is between them.
const FRAMES: usize = 3;

/// The most of them: more are too small.
const MOST_FRAMES: usize = 5;

/// All strips that there are yet.
#[derive(Resource, Debug)]
pub struct GalleryThumbnails {
    waiting: VecDeque<StripTask>,
    running: Option<(StripTask, BackgroundJob<StripsByName, StripError>)>,
    done: StripsByName,
}

type StripsByName = HashMap<String, RgbaImage>;

/// How strips are come by.
#[derive(Clone, Debug, PartialEq, Eq)]
enum StripTask {
    /// Those of an earlier start, all at once.
    Read,
    /// The one of that project.
    Draw(String),
}

impl FromWorld for GalleryThumbnails {
    fn from_world(world: &mut World) -> Self {
        let entries = &world.resource::<GalleryEntries>().0;
        let drawn = entries
            .iter()
            .map(|entry| StripTask::Draw(entry.name.clone()));
        Self {
            waiting: std::iter::once(StripTask::Read).chain(drawn).collect(),
            running: None,
            done: StripsByName::new(),
        }
    }
}

impl GalleryThumbnails {
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

    /// Takes in what is done, and says what comes next.
    fn next(&mut self, is_urgent_elsewhere: bool) -> Option<StripTask> {
        if let Some((task, job)) = &self.running {
            if is_urgent_elsewhere {
                job.cancel();
            }
            match job.poll()? {
                Ok(strips) => self.done.extend(strips),
                // It was in the way, and has its turn again.
                Err(_) if job.is_cancelled() => self.waiting.push_front(task.clone()),
                // A project that cannot be shown has no strip; opening it tells why.
                Err(_) => {}
            }
            self.running = None;
        }
        loop {
            match self.waiting.front()? {
                StripTask::Draw(name) if self.done.contains_key(name) => self.waiting.pop_front(),
                StripTask::Draw(_) if is_urgent_elsewhere => return None,
                _ => return self.waiting.pop_front(),
            };
        }
    }
}

/// Takes in a strip that is done and starts the next, while nothing more urgent is going on.
pub fn advance(
    session: Res<Session>,
    kept: Res<GalleryStripCache>,
    mut thumbnails: ResMut<GalleryThumbnails>,
) {
    // Looked at in each frame; nobody asks whether it has changed.
    let thumbnails = thumbnails.bypass_change_detection();
    let Some(task) = thumbnails.next(session.work().is_some()) else {
        return;
    };
    let (kept, theirs) = (kept.clone(), task.clone());
    let job = BackgroundJob::start("a thumbnail", move |progress| match theirs {
        StripTask::Read => Ok(kept.read(STRIP_PX)),
        StripTask::Draw(name) => {
            let strip = strip(&name, progress)?;
            // Nobody has asked for it: what cannot be kept is drawn again at the next start.
            kept.keep(&name, &strip).ok();
            Ok(HashMap::from([(name, strip)]))
        }
    });
    thumbnails.running = Some((task, job));
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
    let drawn = draw_strip(&sequence, style, &times, cell)?;
    // What has its own paint was drawn for paper: navy letters are lost on a dark window.
    if loaded.designs.iter().all(|design| design.coats.is_empty()) {
        return Ok(drawn);
    }
    let Rgb([r, g, b]) = style.ground;
    let mut paper = RgbaImage::from_pixel(STRIP_PX.0, STRIP_PX.1, image::Rgba([r, g, b, 255]));
    image::imageops::overlay(&mut paper, &drawn, 0, 0);
    Ok(paper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::still_wanted;

    fn with(waiting: impl IntoIterator<Item = StripTask>) -> GalleryThumbnails {
        GalleryThumbnails {
            waiting: waiting.into_iter().collect(),
            running: None,
            done: StripsByName::new(),
        }
    }

    fn draw(name: &str) -> StripTask {
        StripTask::Draw(name.to_owned())
    }

    /// What comes next, once what is running has answered.
    fn next(thumbnails: &mut GalleryThumbnails, is_urgent_elsewhere: bool) -> Option<StripTask> {
        while thumbnails.running.is_some() {
            if let Some(next) = thumbnails.next(is_urgent_elsewhere) {
                return Some(next);
            }
            std::thread::yield_now();
        }
        thumbnails.next(is_urgent_elsewhere)
    }

    #[test]
    fn what_was_read_is_not_drawn() {
        let mut thumbnails = with([StripTask::Read, draw("gears"), draw("letters")]);
        // Read at once, whatever else goes on.
        assert_eq!(next(&mut thumbnails, true), Some(StripTask::Read));
        let strip = HashMap::from([("gears".to_owned(), RgbaImage::new(1, 1))]);
        thumbnails.running = Some((
            StripTask::Read,
            BackgroundJob::start("strips", move |_| Ok(strip)),
        ));
        assert_eq!(next(&mut thumbnails, false), Some(draw("letters")));
        assert!(thumbnails.get("gears").is_some() && !thumbnails.is_busy());
    }

    #[test]
    fn a_strip_makes_way_and_has_its_turn_again() {
        let mut thumbnails = with([draw("letters")]);
        let endless = BackgroundJob::start("a strip", |progress| {
            loop {
                still_wanted(progress)?;
                std::thread::yield_now();
            }
        });
        thumbnails.running = Some((draw("gears"), endless));
        assert_eq!(next(&mut thumbnails, true), None);
        assert_eq!(next(&mut thumbnails, false), Some(draw("gears")));
        assert_eq!(next(&mut thumbnails, false), Some(draw("letters")));
        assert_eq!(next(&mut thumbnails, false), None);
    }
}
