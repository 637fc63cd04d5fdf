//! Draws the gallery's thumbnails in the background, one after the other. A thumbnail is a strip of
//! a few in-betweens of a gallery project.

use std::collections::{HashMap, VecDeque};

use bevy::prelude::{DetectChangesMut, FromWorld, Res, ResMut, Resource, UVec2, World};
use image::RgbaImage;

use crate::app::files::invitation::EXAMPLES;
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

/// Width and height of a strip in pixels: twice its size on screen at scale factor 1.
pub const STRIP_PX: (u32, u32) = (384, 128);

/// Number of in-betweens in the strip of a project with two designs: the start and the end of the
/// film, and one halfway between them (heuristic).
const FRAMES: usize = 3;

/// Maximum number of in-betweens in a strip (heuristic: more would be too small).
const MAX_FRAMES: usize = 5;

/// The strips read or drawn so far, the tasks that produce the others, and the running task.
#[derive(Resource, Debug)]
pub struct GalleryThumbnails {
    waiting: VecDeque<StripTask>,
    running: Option<(StripTask, BackgroundJob<StripsByName, StripError>)>,
    done: StripsByName,
}

type StripsByName = HashMap<String, RgbaImage>;

/// Task of a background job: to read cached strips or to draw a strip.
#[derive(Clone, Debug, PartialEq, Eq)]
enum StripTask {
    /// Read all strips cached by an earlier run of the program.
    Read,
    /// Draw the strip of the project with this name.
    Draw(String),
}

impl FromWorld for GalleryThumbnails {
    fn from_world(world: &mut World) -> Self {
        let entries = &world.resource::<GalleryEntries>().0;
        let mut names: Vec<&String> = entries.iter().map(|entry| &entry.name).collect();
        // The examples of the invitation come first, because the invitation shows their strips at
        // the start.
        names.sort_by_key(|name| !EXAMPLES.contains(&name.as_str()));
        let drawing_tasks = names.into_iter().map(|name| StripTask::Draw(name.clone()));
        Self {
            waiting: std::iter::once(StripTask::Read)
                .chain(drawing_tasks)
                .collect(),
            running: None,
            done: StripsByName::new(),
        }
    }
}

impl GalleryThumbnails {
    /// Whether strips are being drawn or wait to be drawn.
    pub fn is_busy(&self) -> bool {
        self.running.is_some() || !self.waiting.is_empty()
    }

    /// Strip of a gallery project, once available, with straight alpha; its background is
    /// transparent unless the designs have their own colours.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&RgbaImage> {
        self.done.get(name)
    }

    /// Collects finished strips and returns the next task. While more urgent work is running
    /// (`is_urgent_elsewhere`), cancels the running task and returns no drawing task.
    fn next(&mut self, is_urgent_elsewhere: bool) -> Option<StripTask> {
        if let Some((task, job)) = &self.running {
            // Strips must not slow down the transition that the user waits for.
            if is_urgent_elsewhere {
                job.cancel();
            }
            match job.poll()? {
                Ok(strips) => self.done.extend(strips),
                // The job was cancelled in favour of more urgent work and is tried again later.
                Err(_) if job.is_cancelled() => self.waiting.push_front(task.clone()),
                // A project that cannot be shown has no strip. The user sees the reason on opening
                // the project.
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

/// Collects finished strips and starts the next one unless more urgent work is running.
pub fn advance(
    session: Res<Session>,
    cache: Res<GalleryStripCache>,
    mut thumbnails: ResMut<GalleryThumbnails>,
) {
    // No system reacts to changes of this resource, so none are reported.
    let thumbnails = thumbnails.bypass_change_detection();
    let Some(task) = thumbnails.next(session.work().is_some()) else {
        return;
    };
    let (cache, job_task) = (cache.clone(), task.clone());
    let job = BackgroundJob::start("the gallery thumbnails", move |progress| match job_task {
        StripTask::Read => Ok(cache.read(STRIP_PX)),
        StripTask::Draw(name) => {
            let strip = strip(&name, progress)?;
            // A strip that cannot be cached is drawn again at the next start.
            cache.store(&name, &strip).ok();
            Ok(HashMap::from([(name, strip)]))
        }
    });
    thumbnails.running = Some((task, job));
}

/// Reason why a strip could not be drawn. It is not reported, because the user sees it on opening
/// the project.
type StripError = Box<dyn std::error::Error + Send + Sync>;

/// Loads and builds a gallery project and draws its strip.
fn strip(name: &str, progress: &dyn Progress) -> Result<RgbaImage, StripError> {
    let loaded = gallery::load(name)?;
    let segments = loaded.segments();
    let built = segments.iter().map(|segment| Ok(segment.build(progress)?));
    let built: Vec<Transition> = built.collect::<Result<_, StripError>>()?;
    let sequence = Sequence::new(built).ok_or("a project has at least one segment")?;
    let sequence = sequence.closed(loaded.project.ends_where_it_starts());
    let timing = loaded.project.timing;
    // With several segments, the strip has as many in-betweens as designs, up to `MAX_FRAMES`.
    let frames = if segments.len() > 1 {
        segments.len() + 1
    } else {
        FRAMES
    };
    let frames = frames.min(MAX_FRAMES);
    let times = even_times(timing.from, timing.to, frames);
    let cell_px = UVec2::new(STRIP_PX.0 / frames as u32, STRIP_PX.1);
    let style = &loaded.project.style;
    let strip = draw_strip(&sequence, style, &times, cell_px)?;
    // Designs with their own colours get the project's background colour: navy letters would vanish
    // on a dark window.
    if !loaded.designs.iter().any(|design| design.is_painted()) {
        return Ok(strip);
    }
    let Rgb([r, g, b]) = style.ground;
    let mut paper = RgbaImage::from_pixel(STRIP_PX.0, STRIP_PX.1, image::Rgba([r, g, b, 255]));
    image::imageops::overlay(&mut paper, &strip, 0, 0);
    Ok(paper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::check_cancelled;

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

    /// Returns the next task, after the running one has finished.
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
    fn cached_strips_are_not_drawn_again() {
        let mut thumbnails = with([StripTask::Read, draw("gears"), draw("letters")]);
        // Reading the cache does not wait for other work.
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
    fn a_strip_yields_to_urgent_work_and_is_retried() {
        let mut thumbnails = with([draw("letters")]);
        let endless = BackgroundJob::start("a strip", |progress| {
            loop {
                check_cancelled(progress)?;
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
