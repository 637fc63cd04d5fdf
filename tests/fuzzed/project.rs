//! Any text as a project with designs of the gallery: it becomes frames or a one-line error.

use super::design_check::check_message;
use morphospace::Camera;
use morphospace::project::{LoadedProject, Project, ProjectError};
use morphospace::transition::BuildQuality;
use morphospace::work::progress::Progress;
use std::time::{Duration, Instant};

/// Longer side of the frames, in pixels (resource limit: frames are drawn for each input).
const SIZE_PX: u32 = 24;

/// Progress that cancels the work after a deadline.
struct Deadline(Instant);

impl Progress for Deadline {
    fn report(&self, _stage: &'static str, _fraction: f64) {}

    fn is_cancelled(&self) -> bool {
        Instant::now() > self.0
    }

    fn is_patient(&self) -> bool {
        false
    }
}

/// Reads a project and the designs of the gallery that it names, and draws its first transition at
/// both ends and between them. Work that takes longer than two seconds is cancelled.
pub fn check_project(text: &str) {
    if let Err(error) = drawn(text) {
        check_message(&error);
    }
}

fn drawn(text: &str) -> Result<(), ProjectError> {
    let mut project = Project::parse(text)?;
    // Best quality often takes longer than the deadline. The search for positions and the proof of
    // collisions, which run only there, are not tested here.
    project.options.quality = BuildQuality::Draft;
    // Without a folder, paths lead to designs in memory, and none is opened.
    let loaded = LoadedProject::load(project, None)?;
    let progress = Deadline(Instant::now() + Duration::from_secs(2));
    let transition = loaded.segments()[0].build(&progress)?;
    let camera = Camera::around(transition, SIZE_PX);
    for t in [0.0, 0.4, 1.0] {
        let pixels = camera.pixels(t);
        assert_eq!(pixels.width().max(pixels.height()), SIZE_PX);
    }
    Ok(())
}
