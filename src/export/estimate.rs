//! Estimates the file size and the duration of the export of a film from parts of it.
//!
//! A film of pixels is divided into equal parts, and a section from the middle of each part is
//! exported. The frames of a section after its first one stand for their part; the first frame
//! stands for all fixed costs. Files that store differences between frames are divided by their
//! distinct frames, because the frames of a pause cost nearly nothing. Vector animations are
//! exported whole, because their size depends on when shapes appear, which no section shows.

use std::path::Path;
use std::time::Instant;

use crate::work::progress::{Progress, ProgressSpan};

use super::camera::Camera;
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::gif::{film_palette, write_gif_section};
use super::palette::GifPalette;
use super::target::{ExportTarget, FilmKind, NumberedFiles, StillKind};
use super::write_film;

/// Number of parts of a film of which a section is exported (heuristic: the start, the middle and
/// the end of each direction usually differ).
const PARTS: usize = 5;

/// Number of frames of a section that count (heuristic: short, because the duration of the estimate
/// is proportional to it).
const SECTION_FRAMES: usize = 6;

/// Number of frames of a section of a WebM video that count (derived: VP9 looks 25 frames ahead
/// before it decides how precisely it stores a frame).
const WEBM_SECTION_FRAMES: usize = 25;

/// Estimated cost of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmCost {
    /// Duration of the export in seconds.
    pub secs: f64,
    /// Size of all exported files in bytes.
    pub bytes: f64,
}

impl FilmCost {
    /// Estimates the cost of exporting a film as a file of the given kind, or as numbered PNG images
    /// if there is none. `folder` receives temporary files, which the caller removes.
    ///
    /// # Errors
    /// [`ExportError`] if a section cannot be written, or the estimate is cancelled.
    pub fn estimate(
        camera: &Camera,
        film: &FilmSpec,
        kind: Option<FilmKind>,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<Self, ExportError> {
        let palette = match kind {
            Some(FilmKind::Gif) => Some(film_palette(camera, &film.runs(), progress)?),
            _ => None,
        };
        let mut trial = TrialExport {
            camera,
            kind,
            palette,
            folder,
            count: 0,
        };
        let steps = trial.steps(film);
        let counted = match kind {
            Some(FilmKind::WebM) => WEBM_SECTION_FRAMES,
            _ => SECTION_FRAMES,
        };
        let is_short = steps.len() <= PARTS * (counted + 1);
        if is_short || kind.is_some_and(FilmKind::is_vector) {
            return trial.export(film, progress);
        }
        let per_part = (steps.len() - 1) as f64 / PARTS as f64;
        let mut cost = Self::default();
        for part in 0..PARTS {
            let [start, end] = [part, part + 1].map(|part| part as f64 / PARTS as f64);
            let progress = ProgressSpan::new(progress, start, end);
            let middle = (part as f64 + 0.5) * per_part;
            let first = (middle - 0.5 * counted as f64).max(0.0) as usize;
            let [from, to] = [steps[first], steps[first + counted]];
            // Both ranges are part of the film.
            let [one, some] = [from..from + 1, from..to + 1].map(|range| film.frame_range(range));
            let one = trial.export(&one.unwrap_or_else(|_| film.clone()), &progress)?;
            let some = trial.export(&some.unwrap_or_else(|_| film.clone()), &progress)?;
            let share = per_part / counted as f64;
            cost.secs += (some.secs - one.secs).max(0.0) * share;
            cost.bytes += (some.bytes - one.bytes).max(0.0) * share;
            if part == 0 {
                cost.secs += one.secs;
                cost.bytes += one.bytes;
            }
        }
        Ok(cost)
    }
}

/// Exports parts of a film to temporary files.
struct TrialExport<'a> {
    camera: &'a Camera,
    kind: Option<FilmKind>,
    /// Palette of the whole film, for a GIF.
    palette: Option<GifPalette>,
    folder: &'a Path,
    /// Number of parts exported so far.
    count: usize,
}

impl TrialExport<'_> {
    /// Returns the numbers of the frames that cost something: the last one of each run of equal
    /// frames, or all frames if each is stored on its own.
    fn steps(&self, film: &FilmSpec) -> Vec<usize> {
        let first = film.first_number();
        match self.kind {
            None | Some(FilmKind::Mov) => (first..first + film.times().len()).collect(),
            Some(_) => film
                .runs()
                .iter()
                .map(|run| run.first + run.count - 1)
                .collect(),
        }
    }

    /// Exports a film and measures its cost.
    fn export(
        &mut self,
        film: &FilmSpec,
        progress: &dyn Progress,
    ) -> Result<FilmCost, ExportError> {
        self.count += 1;
        let name = format!("trial-{}", self.count);
        let target = match self.kind {
            Some(kind) => ExportTarget::Film(kind, self.folder.join(&name)),
            None => ExportTarget::Numbered(NumberedFiles {
                folder: self.folder.join(&name),
                prefix: String::new(),
                digits: 1,
                suffix: ".png".to_owned(),
                kind: StillKind::Png,
            }),
        };
        let started = Instant::now();
        let files = match (&self.palette, &target) {
            (Some(palette), ExportTarget::Film(_, path)) => {
                write_gif_section(self.camera, film, palette, path, progress)?;
                vec![path.clone()]
            }
            _ => write_film(self.camera, film, &target, progress)?,
        };
        let secs = started.elapsed().as_secs_f64();
        let mut bytes = 0;
        for file in &files {
            bytes += file.metadata().map_err(ExportError::write(file))?.len();
        }
        Ok(FilmCost {
            secs,
            bytes: bytes as f64,
        })
    }
}
