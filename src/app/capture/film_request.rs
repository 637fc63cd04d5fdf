//! One film or comparison sheet to export, with a copy of everything it needs, so that the project
//! may change during the export.

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
use crate::settings::Choice;
use crate::transition::Sequence;
use crate::work::progress::{Cancelled, Progress};

/// Reason why a film or comparison sheet was not exported.
#[derive(Debug, thiserror::Error)]
pub enum FilmExportError {
    /// Cancelled by the user.
    #[error("Export cancelled")]
    Cancelled,
    /// The timing or the size gives no film.
    #[error(transparent)]
    Film(#[from] FilmFramingError),
    /// The film lacks the frames that the estimate would export.
    #[error(transparent)]
    Section(#[from] FilmSpecError),
    /// The output file could not be created.
    #[error(transparent)]
    File(#[from] CreateFileError),
    /// The file type cannot hold a film.
    #[error(transparent)]
    Target(#[from] ExportTargetError),
    /// The comparison sheet's width or height in pixels is out of range.
    #[error(transparent)]
    Size(#[from] PixelSizeError),
    /// The settings do not fit the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// The temporary folder for the unfinished export could not be created.
    #[error(transparent)]
    ScratchFolder(#[from] std::io::Error),
    /// Writing failed.
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

/// Number of in-betweens per method on a comparison sheet (heuristic).
const SHEET_COLUMNS: usize = 7;

/// Number of film frames exported to estimate the duration and size of an export (heuristic).
const TRIAL_FRAMES: usize = 12;

/// Longer side of the preview image, which shows the film frame being exported, in pixels
/// (heuristic).
const PREVIEW_PX: f64 = 240.0;

/// Minimum time between two preview images during an export (heuristic).
const PREVIEW_EVERY: Duration = Duration::from_millis(400);

/// Image of the film frame being exported, shared with the export's thread.
#[derive(Clone, Debug, Default)]
pub struct FilmPreview(Arc<Mutex<Option<Arc<RgbaImage>>>>);

impl FilmPreview {
    /// Image of the film frame drawn last; `None` until the first image is drawn.
    #[must_use]
    pub fn get(&self) -> Option<Arc<RgbaImage>> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

/// Estimated cost of an export.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmCost {
    /// Duration of the export in seconds.
    pub secs: f64,
    /// Size of all exported files in bytes.
    pub bytes: f64,
}

/// A film or comparison sheet to export.
#[derive(Clone, Debug)]
pub struct FilmRequest {
    project: Project,
    sequence: Sequence,
    options: FilmExportOptions,
    /// Names of the designs along the film.
    names: Vec<String>,
    /// Background colour; `None` is transparent.
    ground: Option<Rgb>,
    format: FilmFileFormat,
    folder: PathBuf,
    stem: String,
    scratch: ScratchFolder,
}

impl FilmRequest {
    /// Captures the current project and settings; `None` if nothing is on the stage.
    #[must_use]
    pub fn new(
        preferences: &Preferences,
        session: &Session,
        folder: &CaptureFolder,
        scratch: &ScratchFolder,
    ) -> Option<Self> {
        let project = session.whole_project()?.clone();
        let ground = project.style.ground;
        let format = preferences.format(project.content);
        Some(Self {
            project,
            sequence: session.sequence()?,
            options: preferences.film,
            names: session.names_along_path(),
            ground: (!preferences.film.is_transparent).then_some(ground),
            format,
            folder: folder.0.clone(),
            stem: session.file_stem(),
            scratch: scratch.clone(),
        })
    }

    /// Exports the film under a name that is not in use; returns its path.
    ///
    /// # Errors
    /// The settings give no film, or the film cannot be written. In this case no incomplete file is
    /// left.
    pub fn export(
        self,
        preview: &FilmPreview,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        check_writable(&self.folder)?;
        let temp_dir = self.scratch.create_temp_dir()?;
        let path = self.path_in(temp_dir.path(), "film")?;
        let (camera, film) = self.camera_and_film()?;
        let previewing = PreviewingProgress::new(&camera, &film, preview, progress);
        write_film(
            &camera,
            &film,
            &ExportTarget::of_path(&path)?.preferring_film(),
            &previewing,
        )?;
        Ok(move_to_free_name(&path, &self.folder, &self.stem)?)
    }

    /// Returns the path of the export in `folder`: a file `name` with the extension of the file
    /// type or, for PNG images, a folder `name`, which is created.
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

    /// Estimates the cost of the export: exports one film frame, then [`TRIAL_FRAMES`] film frames,
    /// and extrapolates to the whole film.
    ///
    /// # Errors
    /// The settings give no film, or the exported frames cannot be written.
    pub fn estimate_cost(self, progress: &dyn Progress) -> Result<FilmCost, FilmExportError> {
        let folder = self.scratch.create_temp_dir()?;
        let (camera, film) = self.camera_and_film()?;
        let first = typical_start(film.times());
        let part =
            |frames: usize| film.frame_range(first..(first + frames).min(film.times().len()));
        let cost = |film: &FilmSpec, name: &str| -> Result<FilmCost, FilmExportError> {
            let path = self.path_in(folder.path(), name)?;
            let started = Instant::now();
            write_film(
                &camera,
                film,
                &ExportTarget::of_path(&path)?.preferring_film(),
                progress,
            )?;
            Ok(FilmCost {
                secs: started.elapsed().as_secs_f64(),
                bytes: size_on_disk(&path)? as f64,
            })
        };
        let (one, some) = (cost(&part(1)?, "one")?, cost(&part(TRIAL_FRAMES)?, "some")?);
        // The cost of the first film frame includes the fixed costs. Each further distinct film
        // frame is assumed to cost as much as the average trial frame.
        let ratio =
            (film.runs().len() - 1) as f64 / (part(TRIAL_FRAMES)?.runs().len().max(2) - 1) as f64;
        let extrapolate = |one: f64, some: f64| one + (some - one).max(0.0) * ratio;
        Ok(FilmCost {
            secs: extrapolate(one.secs, some.secs),
            bytes: extrapolate(one.bytes, some.bytes),
        })
    }

    /// Returns the camera and the film to export. A ping-pong film includes the way back, so that a
    /// player can repeat it without a jump.
    fn camera_and_film(&self) -> Result<(Camera, FilmSpec), FilmExportError> {
        let (style, stops) = (self.project.style, &self.project.stops);
        let timing = &self.project.timing;
        let (film, view) = frame_film(&self.sequence, timing, stops, &self.options)?;
        let film = film.with_title(&self.project.title);
        let names = self.names.iter().map(String::as_str);
        let captions = Captions::new(stops, names, style.ground);
        let is_opaque = self.format == FilmFileFormat::OPAQUE;
        let camera = Camera {
            sequence: self.sequence.clone(),
            style,
            view,
            // A file type without transparency gets the background colour in any case.
            ground: self.ground.or(is_opaque.then_some(style.ground)),
            captions: self.options.layout.has_captions.then_some(captions),
        };
        Ok((camera, film))
    }

    /// Exports a comparison sheet: one row for each method that suits the pair of designs.
    ///
    /// # Errors
    /// No method suits the designs, or the sheet cannot be written.
    pub fn export_method_sheet(
        self,
        staged: &LoadedProject,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        check_writable(&self.folder)?;
        let rows = MethodRow::all(&staged.spec()?, progress)?;
        // The in-betweens on the sheet span t from 0 to 1 for a single segment, and the film's
        // range of t for a whole project.
        let timing = &staged.project.timing;
        let times = if staged.is_segment() {
            even_times(0.0, 1.0, SHEET_COLUMNS)
        } else {
            even_times(timing.from, timing.to, SHEET_COLUMNS)
        };
        let drawing = comparison_sheet(&rows, &self.project.style, &times, self.ground)?;
        let temp_dir = self.scratch.create_temp_dir()?;
        let path = temp_dir.path().join("methods.png");
        write_still(&drawing, StillKind::Png, &path)?;
        let stem = format!("{}-methods", self.stem);
        Ok(move_to_free_name(&path, &self.folder, &stem)?)
    }
}

/// Returns the index of the first image of the film that is exported for the estimate.
///
/// The estimate exports [`TRIAL_FRAMES`] consecutive images, during which t never pauses. Of all
/// such sections of the film, this function selects the one whose mean speed is closest to that of
/// the film without its pauses, because fast sections would not be representative. The index is 0
/// if there is no such section.
fn typical_start(times: &[f64]) -> usize {
    let moves: Vec<f64> = times
        .windows(2)
        .map(|two| (two[1] - two[0]).abs())
        .collect();
    let moving = moves.iter().filter(|step| **step > 0.0).count();
    let mean = moves.iter().sum::<f64>() / moving.max(1) as f64;
    let tried = moves.windows(TRIAL_FRAMES - 1).enumerate();
    let moving = tried.filter(|(_, steps)| steps.iter().all(|step| *step > 0.0));
    let deviation = |steps: &[f64]| (steps.iter().sum::<f64>() / steps.len() as f64 - mean).abs();
    let typical = moving.min_by(|(_, a), (_, b)| deviation(a).total_cmp(&deviation(b)));
    typical.map_or(0, |(first, _)| first)
}

/// Size of a file, or of all files in a folder, in bytes.
fn size_on_disk(path: &Path) -> std::io::Result<u64> {
    if !path.is_dir() {
        return Ok(path.metadata()?.len());
    }
    let mut all = 0;
    for entry in path.read_dir()? {
        all += entry?.metadata()?.len();
    }
    Ok(all)
}

/// Progress receiver that forwards all reports. It also draws the film frame being exported for the
/// preview, at most once per [`PREVIEW_EVERY`].
struct PreviewingProgress<'a> {
    camera: Camera,
    times: &'a [f64],
    preview: &'a FilmPreview,
    /// Time at which the last image was drawn; `None` before the first.
    last_drawn: Mutex<Option<Instant>>,
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
            last_drawn: Mutex::new(None),
            progress,
        }
    }
}

impl Progress for PreviewingProgress<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        self.progress.report(stage, fraction);
        // If another thread is drawing an image already, this one draws none.
        let Ok(mut last_drawn) = self.last_drawn.try_lock() else {
            return;
        };
        if last_drawn.is_some_and(|last| last.elapsed() < PREVIEW_EVERY) {
            return;
        }
        let index = (fraction * (self.times.len() - 1) as f64) as usize;
        let image = self
            .camera
            .pixels(self.times[index.min(self.times.len() - 1)]);
        let mut preview = self
            .preview
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *preview = Some(Arc::new(image));
        *last_drawn = Some(Instant::now());
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
    fn trial_frames_move_at_average_speed() {
        let pause = [0.0; 20];
        let slow = (1..=20).map(|k| f64::from(k) * 0.001);
        let even = (1..=50).map(|k| 0.02 + f64::from(k) * 0.01);
        let times: Vec<f64> = pause.into_iter().chain(slow).chain(even).collect();
        let first = typical_start(&times);
        let moves = times[first + TRIAL_FRAMES - 1] - times[first];
        let mean = (times[times.len() - 1] - times[0]) / 70.0;
        assert!(
            (moves / (TRIAL_FRAMES - 1) as f64 - mean).abs() < 0.5 * mean,
            "{first}"
        );
        assert_eq!(
            [
                typical_start(&pause),
                typical_start(&[]),
                typical_start(&[0.0, 1.0])
            ],
            [0; 3]
        );
    }
}
