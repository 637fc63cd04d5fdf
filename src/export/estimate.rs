//! Estimates the file size and the duration of the export of a film from parts of it.
//!
//! A film of pixels is divided into equal parts by its distinct frames, and a section from the
//! middle of each part is exported. The frames of a section after its first one stand for their
//! part; the first frame of the film stands for all fixed costs. Vector animations are exported
//! whole, because their size depends on when shapes appear, which no section shows.

use std::path::Path;
use std::time::Instant;

use crate::work::progress::{Progress, ProgressSpan};

use super::camera::Camera;
use super::error::ExportError;
use super::film_spec::{FilmSpec, FrameRun};
use super::target::{ExportTarget, FilmKind, NumberedFiles, StillKind};
use super::write_film;

/// Number of parts of a film of which a section is exported (heuristic: the start, the middle and
/// the end of each direction usually differ).
const PARTS: usize = 5;

/// Number of distinct frames of a section that count (heuristic: short, because the duration of the
/// estimate is proportional to it).
const SECTION_FRAMES: usize = 6;

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
        let mut trial = TrialExport {
            camera,
            kind,
            folder,
            count: 0,
        };
        let runs = film.runs();
        let is_short = runs.len() <= PARTS * (SECTION_FRAMES + 1);
        if is_short || kind.is_some_and(FilmKind::is_vector) {
            return trial.export(film, progress);
        }
        let per_part = (runs.len() - 1) as f64 / PARTS as f64;
        let mut cost = Self::default();
        for part in 0..PARTS {
            let done = |k: usize| (part + k) as f64 / PARTS as f64;
            let progress = ProgressSpan::new(progress, done(0), done(1));
            let middle = (part as f64 + 0.5) * per_part;
            let first = (middle - 0.5 * SECTION_FRAMES as f64).max(0.0) as usize;
            let one = trial.section(film, &runs, first, 0, &progress)?;
            let some = trial.section(film, &runs, first, SECTION_FRAMES, &progress)?;
            let share = per_part / SECTION_FRAMES as f64;
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
    folder: &'a Path,
    /// Number of parts exported so far.
    count: usize,
}

impl TrialExport<'_> {
    /// Exports the distinct frame with the index `first` and the given number of distinct frames
    /// after it, with all frames that repeat the ones in between.
    fn section(
        &mut self,
        film: &FilmSpec,
        runs: &[FrameRun],
        first: usize,
        more: usize,
        progress: &dyn Progress,
    ) -> Result<FilmCost, ExportError> {
        let (start, end) = (runs[first], runs[(first + more).min(runs.len() - 1)]);
        let range = start.first + start.count - 1..end.first.max(start.first + start.count - 1) + 1;
        // The range is part of the film, so the whole film is never exported instead.
        let section = film.frame_range(range).unwrap_or_else(|_| film.clone());
        self.export(&section, progress)
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
