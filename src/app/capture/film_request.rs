//! Everything that a recording needs, so that the project can change meanwhile.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use image::RgbaImage;

use crate::app::capture::film_framing::{FilmFramingError, frame_film};
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, Preferences};
use crate::app::output_files::{
    CaptureFolder, CreateFileError, ScratchFolder, check_writable, move_to_free_name,
};
use crate::app::session::state::Session;
use crate::colour::Rgb;
use crate::export::{
    Camera, Captions, ExportError, ExportTarget, ExportTargetError, FilmSpec, FilmSpecError,
    MethodRow, PixelSize, PixelSizeError, StillKind, comparison_sheet, even_times, write_film,
    write_still,
};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::settings::choice::Choice;
use crate::transition::Sequence;
use crate::work::progress::{Cancelled, Progress};

/// Why a film or a sheet was not written.
#[derive(Debug, thiserror::Error)]
pub enum FilmExportError {
    /// It was not wanted any more.
    #[error("The recording was cancelled.")]
    Cancelled,
    /// The timing or the size make no film.
    #[error(transparent)]
    Film(#[from] FilmFramingError),
    /// There is no such part of it.
    #[error(transparent)]
    Part(#[from] FilmSpecError),
    /// No file could be made for it.
    #[error(transparent)]
    File(#[from] CreateFileError),
    /// The file is none that a film can go to.
    #[error(transparent)]
    Target(#[from] ExportTargetError),
    /// The sheet would have no size.
    #[error(transparent)]
    Size(#[from] PixelSizeError),
    /// The settings do not go with the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// There is no place to work in.
    #[error(transparent)]
    Workshop(#[from] std::io::Error),
    /// It could not be written.
    #[error(transparent)]
    Export(ExportError),
}

impl From<Cancelled> for FilmExportError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<ExportError> for FilmExportError {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Cancelled(_) => Self::Cancelled,
            error => Self::Export(error),
        }
    }
}

/// The t of a sheet of all methods.
const COLUMNS: usize = 7;

/// How many frames of a film are written to see how long it takes and how large it becomes.
const TRIED: usize = 12;

/// The longer side of the picture that shows how far a film is, in pixels.
const PREVIEW_PX: f64 = 240.0;

/// How often it is drawn anew.
const PREVIEW_EVERY: Duration = Duration::from_millis(400);

/// The frame that a film has come to.
#[derive(Clone, Debug, Default)]
pub struct FilmPreview(Arc<Mutex<Option<Arc<RgbaImage>>>>);

impl FilmPreview {
    /// The picture, once there is one.
    #[must_use]
    pub fn get(&self) -> Option<Arc<RgbaImage>> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

/// What a film costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmCost {
    /// Seconds to write it.
    pub secs: f64,
    /// Size of the file, or of all of them.
    pub bytes: f64,
}

/// A film, or a sheet, as it was asked for.
#[derive(Clone, Debug)]
pub struct FilmRequest {
    project: Project,
    sequence: Sequence,
    look: FilmExportOptions,
    names: Vec<String>,
    /// None where it is transparent.
    ground: Option<Rgb>,
    format: FilmFileFormat,
    folder: PathBuf,
    stem: String,
    workshop: ScratchFolder,
}

impl FilmRequest {
    /// None where nothing is on the stage.
    #[must_use]
    pub fn new(
        preferences: &Preferences,
        session: &Session,
        (folder, workshop): (&CaptureFolder, &ScratchFolder),
    ) -> Option<Self> {
        let project = session.whole()?.clone();
        let ground = project.style.ground;
        let format = preferences.format(project.content);
        Some(Self {
            project,
            sequence: session.sequence()?,
            look: preferences.film,
            names: session.names_on_the_way(),
            ground: (!preferences.film.is_transparent).then_some(ground),
            format,
            folder: folder.0.clone(),
            stem: session.file_stem(),
            workshop: workshop.clone(),
        })
    }

    /// Writes the film under a name that nothing has yet.
    ///
    /// # Errors
    /// There is no film, or it cannot be written; nothing is left of it.
    pub fn carry_out(
        self,
        preview: &FilmPreview,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        check_writable(&self.folder)?;
        let workshop = self.workshop.begin()?;
        let path = self.path_in(workshop.path(), "film")?;
        let (camera, film) = self.film()?;
        let watched = PreviewingProgress::new(&camera, &film, preview, progress);
        write_film(
            &camera,
            &film,
            &ExportTarget::of_path(&path)?.moving(),
            &watched,
        )?;
        Ok(move_to_free_name(&path, &self.folder, &self.stem)?)
    }

    /// A file of the kind that is asked for, or an empty folder for pictures.
    fn path_in(&self, folder: &Path, name: &str) -> std::io::Result<PathBuf> {
        let path = folder.join(name);
        match self.format {
            FilmFileFormat::Film(kind) => Ok(path.with_extension(kind.name().key)),
            FilmFileFormat::Pngs => {
                std::fs::create_dir(&path)?;
                Ok(path)
            }
        }
    }

    /// Writes some frames to see what the whole costs.
    ///
    /// # Errors
    /// There is no film, or not even those can be written.
    pub fn tried(self, progress: &dyn Progress) -> Result<FilmCost, FilmExportError> {
        let folder = self.workshop.begin()?;
        let (camera, film) = self.film()?;
        let first = usual(film.times());
        let part = |frames: usize| film.part(first..(first + frames).min(film.times().len()));
        let cost = |film: &FilmSpec, name: &str| -> Result<FilmCost, FilmExportError> {
            let path = self.path_in(folder.path(), name)?;
            let began = Instant::now();
            write_film(
                &camera,
                film,
                &ExportTarget::of_path(&path)?.moving(),
                progress,
            )?;
            Ok(FilmCost {
                secs: began.elapsed().as_secs_f64(),
                bytes: bytes(&path)? as f64,
            })
        };
        let (one, some) = (cost(&part(1)?, "one")?, cost(&part(TRIED)?, "some")?);
        let more = (film.runs().len() - 1) as f64 / (part(TRIED)?.runs().len().max(2) - 1) as f64;
        let whole = |one: f64, some: f64| one + (some - one).max(0.0) * more;
        Ok(FilmCost {
            secs: whole(one.secs, some.secs),
            bytes: whole(one.bytes, some.bytes),
        })
    }

    /// One pass; where it plays to and fro, the way back too, so that it can be looped.
    fn film(&self) -> Result<(Camera, FilmSpec), FilmExportError> {
        let (style, stops) = (self.project.style, &self.project.stops);
        let timing = (&self.project.timing, stops.as_slice());
        let (film, view) = frame_film(&self.sequence, timing, &self.look)?;
        let film = film.titled(&self.project.title);
        let names = self.names.iter().map(String::as_str);
        let captions = Captions::new(stops, names, style.ground);
        let is_opaque = self.format == FilmFileFormat::OPAQUE;
        let camera = Camera {
            sequence: self.sequence.clone(),
            style,
            view,
            ground: self.ground.or(is_opaque.then_some(style.ground)),
            captions: self.look.layout.has_captions.then_some(captions),
        };
        Ok((camera, film))
    }

    /// A sheet of every method by which the pair can be seen.
    ///
    /// # Errors
    /// There is none, or it cannot be written.
    pub fn compare(
        self,
        staged: &LoadedProject,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        check_writable(&self.folder)?;
        let rows = MethodRow::all(&staged.spec()?, progress)?;
        // Of the two designs that are looked at, from one to the other.
        let timing = &staged.project.timing;
        let times = if staged.is_leg() {
            even_times(0.0, 1.0, COLUMNS)
        } else {
            even_times(timing.from, timing.to, COLUMNS)
        };
        let drawing = comparison_sheet(&rows, &self.project.style, &times, self.ground)?;
        let workshop = self.workshop.begin()?;
        let path = workshop.path().join("methods.png");
        write_still(&drawing, StillKind::Png, &path)?;
        let stem = format!("{}-methods", self.stem);
        Ok(move_to_free_name(&path, &self.folder, &stem)?)
    }
}

/// Where the frames that are tried begin: where each moves on, as fast as frames do on average; at
/// rest, or fast, they would tell little of the whole.
fn usual(times: &[f64]) -> usize {
    let moves: Vec<f64> = times
        .windows(2)
        .map(|two| (two[1] - two[0]).abs())
        .collect();
    let moving = moves.iter().filter(|way| **way > 0.0).count();
    let mean = moves.iter().sum::<f64>() / moving.max(1) as f64;
    let tried = moves.windows(TRIED - 1).enumerate();
    let moving = tried.filter(|(_, ways)| ways.iter().all(|way| *way > 0.0));
    let beside = |ways: &[f64]| (ways.iter().sum::<f64>() / ways.len() as f64 - mean).abs();
    let usual = moving.min_by(|(_, a), (_, b)| beside(a).total_cmp(&beside(b)));
    usual.map_or(0, |(first, _)| first)
}

/// The size of a file, or of all files of a folder.
fn bytes(path: &Path) -> std::io::Result<u64> {
    if !path.is_dir() {
        return Ok(path.metadata()?.len());
    }
    let mut all = 0;
    for entry in path.read_dir()? {
        all += entry?.metadata()?.len();
    }
    Ok(all)
}

/// Passes on how far a film is, and now and then draws where it is.
struct PreviewingProgress<'a> {
    camera: Camera,
    times: &'a [f64],
    preview: &'a FilmPreview,
    /// When it was drawn last.
    drawn: Mutex<Option<Instant>>,
    progress: &'a dyn Progress,
}

impl<'a> PreviewingProgress<'a> {
    fn new(
        camera: &Camera,
        film: &'a FilmSpec,
        preview: &'a FilmPreview,
        progress: &'a dyn Progress,
    ) -> Self {
        let size = camera.view.size().as_dvec2();
        let small = size * (PREVIEW_PX / size.max_element()).min(1.0);
        let [width, height] = small.to_array().map(|side| (side as u32).max(1));
        let view = match PixelSize::new(width, height) {
            Ok(size) => camera.view.scaled_to(size),
            Err(_) => camera.view,
        };
        Self {
            camera: Camera {
                view,
                ..camera.clone()
            },
            times: film.times(),
            preview,
            drawn: Mutex::new(None),
            progress,
        }
    }
}

impl Progress for PreviewingProgress<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        self.progress.report(stage, fraction);
        // Where another thread draws already, that will do.
        let Ok(mut drawn) = self.drawn.try_lock() else {
            return;
        };
        if drawn.is_some_and(|last| last.elapsed() < PREVIEW_EVERY) {
            return;
        }
        let at = (fraction * (self.times.len() - 1) as f64) as usize;
        let picture = self.camera.pixels(self.times[at.min(self.times.len() - 1)]);
        let mut shown = self
            .preview
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *shown = Some(Arc::new(picture));
        *drawn = Some(Instant::now());
    }

    fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.progress.is_patient()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_tried_moves_as_the_film_does() {
        let rest = [0.0; 20];
        let slow = (1..=20).map(|k| f64::from(k) * 0.001);
        let even = (1..=50).map(|k| 0.02 + f64::from(k) * 0.01);
        let times: Vec<f64> = rest.into_iter().chain(slow).chain(even).collect();
        let first = usual(&times);
        let moves = times[first + TRIED - 1] - times[first];
        let mean = (times[times.len() - 1] - times[0]) / 70.0;
        assert!(
            (moves / (TRIED - 1) as f64 - mean).abs() < 0.5 * mean,
            "{first}"
        );
        assert_eq!([usual(&rest), usual(&[]), usual(&[0.0, 1.0])], [0; 3]);
    }
}
