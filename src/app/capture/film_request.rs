//! One film or comparison sheet to export, with a copy of everything it needs, so that the project
//! may change during the export.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use image::RgbaImage;

use crate::app::capture::film_framing::{FilmFramingError, frame_film};
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, Preferences};
use crate::app::output_files::{
    CreateFileError, ScratchFolder, check_writable, move_to_free_path, replace_file,
};
use crate::app::session::state::Session;
use crate::colour::Rgb;
use crate::export::{
    Camera, Captions, ExportError, ExportTarget, ExportTargetError, FilmCost, FilmSpec, MethodRow,
    PixelSize, PixelSizeError, StillKind, comparison_sheet, even_times, write_film, write_still,
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
    scratch: ScratchFolder,
}

impl FilmRequest {
    /// Captures the current project and settings; `None` if nothing is on the stage.
    #[must_use]
    pub fn new(
        preferences: &Preferences,
        session: &Session,
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
            scratch: scratch.clone(),
        })
    }

    /// Exports the film to the file that the user chose; returns its path. The extension of a film
    /// decides the file type; without one, that of the chosen file type is added.
    ///
    /// # Errors
    /// The settings give no film, or the film cannot be written. In this case no incomplete file is
    /// left.
    pub fn export(
        mut self,
        chosen: &Path,
        preview: &FilmPreview,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        self.format = FilmFileFormat::of_path(chosen).unwrap_or(self.format);
        let destination = ExportDestination::new(chosen, self.format.extension())?;
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
        Ok(destination.receive(&path)?)
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

    /// Estimates the cost of the export.
    ///
    /// # Errors
    /// The settings give no film, or the frames that the estimate exports cannot be written.
    pub fn estimate_cost(self, progress: &dyn Progress) -> Result<FilmCost, FilmExportError> {
        let folder = self.scratch.create_temp_dir()?;
        let (camera, film) = self.camera_and_film()?;
        let kind = self.format.kind();
        Ok(FilmCost::estimate(
            &camera,
            &film,
            kind,
            folder.path(),
            progress,
        )?)
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
        let is_opaque = !self.format.can_be_transparent();
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
        chosen: &Path,
        progress: &dyn Progress,
    ) -> Result<PathBuf, FilmExportError> {
        let destination = ExportDestination::new(chosen, Some(SHEET_KIND.name().key))?;
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
        let path = temp_dir.path().join("methods");
        write_still(&drawing, SHEET_KIND, &path)?;
        Ok(destination.receive(&path)?)
    }
}

/// File or folder to which the user exports.
struct ExportDestination {
    path: PathBuf,
    /// Whether the user chose to replace an existing file.
    replaces: bool,
}

impl ExportDestination {
    /// Adds the extension of the file type to the path that the user chose, if it is missing, and
    /// checks that the folder can be written to.
    fn new(chosen: &Path, extension: Option<&str>) -> Result<Self, CreateFileError> {
        let has_extension = |wanted: &str| {
            let found = chosen.extension().and_then(|found| found.to_str());
            found.is_some_and(|found| found.eq_ignore_ascii_case(wanted))
        };
        let path = match extension {
            Some(extension) if !has_extension(extension) => chosen.with_added_extension(extension),
            _ => chosen.to_owned(),
        };
        check_writable(path.parent().unwrap_or(Path::new("")))?;
        Ok(Self {
            // The dialog has asked about the path as the user chose it, but about no other.
            replaces: path == chosen && path.is_file(),
            path,
        })
    }

    /// Moves a finished file or folder here, under another name if this one is in use and the user
    /// has not confirmed to replace it; returns its path.
    fn receive(&self, finished: &Path) -> Result<PathBuf, CreateFileError> {
        if self.replaces {
            replace_file(finished, &self.path)?;
            return Ok(self.path.clone());
        }
        move_to_free_path(finished, &self.path)
    }
}

/// File type of comparison sheets.
const SHEET_KIND: StillKind = StillKind::Png;

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
