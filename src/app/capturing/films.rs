//! Films of one pass, drawn and written in the background by the same code as on the command line.

use std::path::{Path, PathBuf};

use bevy::prelude::{MessageReader, Res, ResMut, Resource};

use crate::app::asking::choices::{CaptureScale, RecordFormat};
use crate::app::asking::intent::Intent;
use crate::app::capturing::files::{CaptureFolder, create_new, create_new_folder};
use crate::app::looking::preferences::Preferences;
use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::app::telling::notices::Notices;
use crate::export::{
    Camera, ExportError, Film, FilmKind, MethodRow, PixelSize, StillKind, Target, View, comparison,
    even_times, framing, write_film, write_still,
};
use crate::progress::Progress;
use crate::project::{LoadedProject, Project};
use crate::transition::Transition;

/// Frames a second; GIF's clock of hundredths keeps it exactly.
const FPS: f64 = 25.0;

/// The recording that is going on, if any.
#[derive(Resource, Debug, Default)]
pub struct Recorder(Option<Job<Result<PathBuf, String>>>);

/// The t of a sheet of all methods.
const COLUMNS: usize = 7;

impl Recorder {
    /// What is being recorded and how far it is.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.0.as_ref().map(|job| ("Writing", job.progress().1))
    }

    /// Stops the recording; what was begun is taken away.
    pub fn cancel(&self) {
        if let Some(job) = &self.0 {
            job.cancel();
        }
    }
}

/// Starts and cancels recordings.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut recorder: ResMut<Recorder>,
    mut notices: ResMut<Notices>,
    (session, preferences, folder): (Res<Session>, Res<Preferences>, Res<CaptureFolder>),
) {
    for intent in intents.read() {
        match intent {
            Intent::CancelRecording => recorder.cancel(),
            Intent::Record | Intent::Compare if recorder.0.is_some() => {
                notices.done("A file is being written; wait for it, or cancel it first.");
            }
            Intent::Compare => {
                if let (Some(staged), Some(project), Some(transition)) =
                    (session.staged(), session.project(), session.transition())
                {
                    let order = Order::new(project, transition, &preferences, &session, &folder);
                    recorder.0 = Some(Job::start("a sheet", move |progress| {
                        order.compare(&staged, progress)
                    }));
                }
            }
            Intent::Record => {
                if let (Some(project), Some(transition)) = (session.project(), session.transition())
                {
                    let order = Order::new(project, transition, &preferences, &session, &folder);
                    recorder.0 = Some(Job::start("a film", move |progress| {
                        order.carry_out(progress)
                    }));
                }
            }
            _ => {}
        }
    }
}

/// Says what was written.
pub fn report(mut recorder: ResMut<Recorder>, mut notices: ResMut<Notices>) {
    let Some(answer) = recorder.0.as_ref().and_then(Job::poll) else {
        return;
    };
    recorder.0 = None;
    match answer
        .map_err(|broken| broken.to_string())
        .and_then(|written| written)
    {
        Ok(path) => notices.done(format!("Wrote {}", path.display())),
        Err(error) => notices.problem(error),
    }
}

/// Everything that a recording needs, so that the project can change meanwhile.
struct Order {
    project: Project,
    transition: Transition,
    longer_side_px: u32,
    is_transparent: bool,
    format: RecordFormat,
    folder: PathBuf,
    stem: String,
}

impl Order {
    fn new(
        project: &Project,
        transition: &Transition,
        preferences: &Preferences,
        session: &Session,
        folder: &CaptureFolder,
    ) -> Self {
        Self {
            project: project.clone(),
            transition: transition.clone(),
            longer_side_px: match preferences.capture_scale {
                CaptureScale::One => 960,
                CaptureScale::Two => 1920,
                CaptureScale::FourK => 3840,
            },
            is_transparent: preferences.capture_transparent,
            format: preferences.record_format,
            folder: folder.0.clone(),
            stem: session.file_stem(),
        }
    }

    fn carry_out(self, progress: &dyn Progress) -> Result<PathBuf, String> {
        let (target, path) = self.target()?;
        let written = self.film(&target, progress);
        if written.is_err() {
            // What was begun is no film; where it cannot be taken back, the message still stands.
            remove(&path);
        }
        written.map(|()| path)
    }

    /// One pass there; where it plays to and fro, the way back too, so that it can be looped.
    fn film(&self, target: &Target, progress: &dyn Progress) -> Result<(), String> {
        let film = Film::of_timing(&self.project.timing, &self.project.stops, FPS)
            .map_err(|e| e.to_string())?;
        let bounds = framing(&self.transition, film.times());
        let size = PixelSize::of_shape(bounds, self.longer_side_px);
        let camera = Camera {
            transition: self.transition.clone(),
            style: self.project.style,
            view: View::fit(bounds, size),
            ground: (!self.is_transparent).then_some(self.project.style.ground),
        };
        match write_film(&camera, &film, target, progress) {
            Ok(_) => Ok(()),
            Err(ExportError::Cancelled(_)) => Err("The recording was cancelled.".to_owned()),
            Err(error) => Err(error.to_string()),
        }
    }

    /// A sheet of every method by which the pair can be seen.
    fn compare(self, staged: &LoadedProject, progress: &dyn Progress) -> Result<PathBuf, String> {
        let words = |error: &dyn std::error::Error| error.to_string();
        let spec = staged.spec().map_err(|error| words(&error))?;
        let rows = MethodRow::all(&spec, progress).map_err(|error| words(&error))?;
        let timing = &self.project.timing;
        let times = even_times(timing.from, timing.to, COLUMNS);
        let ground = (!self.is_transparent).then_some(self.project.style.ground);
        let drawing = comparison(&rows, &self.project.style, &times, ground);
        let drawing = drawing.map_err(|error| words(&error))?;
        let stem = format!("{}-methods", self.stem);
        let made = create_new(&self.folder, &stem, "png");
        let (_, path) = made.map_err(|error| words(&error))?;
        let written = write_still(&drawing, StillKind::Png, &path);
        if let Err(error) = written {
            remove(&path);
            return Err(words(&error));
        }
        Ok(path)
    }

    fn target(&self) -> Result<(Target, PathBuf), String> {
        let (extension, kind) = match self.format {
            RecordFormat::Gif => ("gif", FilmKind::Gif),
            RecordFormat::Apng => ("apng", FilmKind::Apng),
            RecordFormat::Mp4 => ("mp4", FilmKind::Mp4),
            RecordFormat::Pngs => return self.numbered(),
        };
        let made = create_new(&self.folder, &self.stem, extension);
        let (_, path) = made.map_err(|error| error.to_string())?;
        Ok((Target::Film(kind, path.clone()), path))
    }

    fn numbered(&self) -> Result<(Target, PathBuf), String> {
        let made = create_new_folder(&self.folder, &self.stem);
        let path = made.map_err(|error| error.to_string())?;
        let target = Target::of_path(&path).map_err(|error| error.to_string())?;
        Ok((target, path))
    }
}

fn remove(path: &Path) {
    if path.is_dir() {
        std::fs::remove_dir_all(path).ok()
    } else {
        std::fs::remove_file(path).ok()
    };
}
