//! Estimates the file size and the duration of the export of a film from parts of it.
//!
//! A film of pixels is divided into equal parts, and a section from the middle of each part is
//! exported. The frames of a section after its first one stand for their part; the first frame
//! stands for all fixed costs. Files that store differences between frames are divided by their
//! distinct frames, because the frames of a pause cost nearly nothing. In a GIF, a pixel is redrawn
//! only when its colour has changed enough, and all pixels of a section's first frame are exact, so
//! the frames that count follow others, after which pixels are redrawn as often as in the film.
//! Vector animations are exported whole, because their size depends on when shapes appear, which no
//! section shows.

use std::path::Path;
use std::time::Instant;

use crate::work::progress::{Progress, ProgressSpan};

use super::camera::Camera;
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::gif::changes::SLACK;
use super::gif::{film_palette, write_gif_section};
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

/// Number of frames of a section of a GIF that do not count, and of those after them that count
/// (derived: after this time, each colour that changes by half a level per frame or faster has been
/// redrawn once, and once more while frames count).
const GIF_SECTION_FRAMES: usize = 2 * SLACK as usize;

/// Estimated cost of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmCost {
    /// Duration of the export in seconds.
    pub secs: f64,
    /// Size of all exported files in bytes.
    pub bytes: f64,
}

impl FilmCost {
    /// Estimates the cost of exporting a film as a file of the given kind, or as numbered PNG
    /// images if there is none. `folder` receives temporary files, which the caller removes.
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
        let mut trial = TrialExport {
            camera,
            kind,
            folder,
            count: 0,
        };
        let steps = trial.steps(film);
        if kind == Some(FilmKind::Gif) && steps.len() > PARTS * (2 * GIF_SECTION_FRAMES + 1) {
            return trial.sections_of_gif(film, &steps, progress);
        }
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
            let progress = part_progress(progress, part);
            let [from, to] = middle_section(&steps, part, counted);
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

/// Returns the share of the progress that belongs to a part.
fn part_progress(progress: &dyn Progress, part: usize) -> ProgressSpan<'_> {
    let [start, end] = [part, part + 1].map(|part| part as f64 / PARTS as f64);
    ProgressSpan::new(progress, start, end)
}

/// Returns the first and the last frame number of the section in the middle of a part, of
/// `length` + 1 frames.
fn middle_section(steps: &[usize], part: usize, length: usize) -> [usize; 2] {
    let per_part = (steps.len() - 1) as f64 / PARTS as f64;
    let middle = (part as f64 + 0.5) * per_part;
    let first = (middle - 0.5 * length as f64).max(0.0) as usize;
    [steps[first], steps[first + length]]
}

/// Exports parts of a film to temporary files.
struct TrialExport<'a> {
    camera: &'a Camera,
    kind: Option<FilmKind>,
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

    /// Estimates the cost of a GIF whose distinct frames have the given numbers.
    fn sections_of_gif(
        &self,
        film: &FilmSpec,
        steps: &[usize],
        progress: &dyn Progress,
    ) -> Result<FilmCost, ExportError> {
        let started = Instant::now();
        let palette = film_palette(self.camera, &film.runs(), progress)?;
        let mut cost = FilmCost {
            secs: started.elapsed().as_secs_f64(),
            bytes: 0.0,
        };
        let per_part = steps.len() as f64 / PARTS as f64;
        for part in 0..PARTS {
            let progress = part_progress(progress, part);
            let [from, to] = middle_section(steps, part, 2 * GIF_SECTION_FRAMES);
            // The range is part of the film.
            let section = film.frame_range(from..to + 1);
            let section = section.unwrap_or_else(|_| film.clone());
            let path = self.folder.join(format!("trial-{part}"));
            let started = Instant::now();
            let sizes = write_gif_section(self.camera, &section, &palette, &path, &progress)?;
            let secs_per_frame = started.elapsed().as_secs_f64() / sizes.len() as f64;
            let counted = &sizes[GIF_SECTION_FRAMES.min(sizes.len() - 1)..];
            let bytes_per_frame = counted.iter().sum::<usize>() as f64 / counted.len() as f64;
            cost.secs += per_part * secs_per_frame;
            cost.bytes += per_part * bytes_per_frame;
            if part == 0 {
                let bytes = path.metadata().map_err(ExportError::write(&path))?.len() as f64;
                let frames = sizes[1..].iter().sum::<usize>() as f64;
                // The first frame, which is stored whole, and the palette.
                cost.bytes += bytes - frames;
            }
        }
        Ok(cost)
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
        let files = write_film(self.camera, film, &target, progress)?;
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
