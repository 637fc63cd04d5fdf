//! Writes a film as a video by feeding raw frames to the ffmpeg on the PATH: MP4, WebM (VP9) and
//! MOV (ProRes 4444). WebM and MOV can be transparent.
//!
//! Guarantees: BT.709 colours, which players assume; all frames of the film at its frame rate. The
//! file replaces an earlier one only if ffmpeg succeeded and can decode as many frames from the
//! file. The exit status alone is not sufficient, because ffmpeg 5.1 reports success even on a full
//! disk. The encoders of ffmpeg determine the file size.
//!
//! - `encoder`: the video file types; `planes`: pixels in their form; `ffmpeg`: runs the program

mod encoder;
mod ffmpeg;
mod planes;

use std::io::{self, Write};
use std::path::Path;
use std::process::{ChildStdin, Command};
use std::sync::OnceLock;

use crate::io::atomic_file::AtomicFile;
use crate::work::progress::{Cancelled, Progress, ProgressSpan};

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::raster::rasterise;
use super::readback::{CHECKING_STAGE, DRAWN_FRACTION};
use encoder::VideoEncoder;
use ffmpeg::{FfmpegMessages, FfmpegOutcome};

pub use encoder::VideoContainer;

/// Writes the film to `path`, and verifies the file before it replaces an earlier one. The video is
/// transparent if the camera has no background. Both sides of the camera's image must be even
/// ([`PixelSize::to_even`](super::PixelSize::to_even)), or ffmpeg refuses it.
///
/// # Errors
/// [`ExportError`] if the background is transparent and the container is MP4, ffmpeg is missing,
/// fails or writes fewer frames than it received, or the export is cancelled.
pub fn write_video(
    camera: &Camera,
    film: &FilmSpec,
    container: VideoContainer,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let encoder = VideoEncoder::new(container, camera.ground.is_none())?;
    // The file is created before ffmpeg is started, so that an unwritable folder is reported first.
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let job = FfmpegJob {
        path,
        temporary: file.temporary_path(),
        progress,
    };
    let size = camera.view.size();
    let command = ffmpeg::encode_command(encoder, size, film.fps(), job.temporary);
    let mut feeding = Ok(());
    let encoding = job.run(command, |mut stdin| {
        feeding = camera.draw_runs(
            &film.runs(),
            DRAWING_STAGE,
            &ProgressSpan::new(progress, 0.0, DRAWN_FRACTION),
            |drawing| Ok(encoder.pixels.planes(rasterise(&drawing))),
            |run, bytes| {
                // ffmpeg expects a constant frame rate, so each frame of a run is written, although
                // all are equal.
                let feed = |_| stdin.write_all(&bytes);
                (0..run.count)
                    .try_for_each(feed)
                    .map_err(ExportError::write(path))
            },
        );
    })?;
    job.check(film.times().len(), &encoding.messages)?;
    feeding?;
    file.commit().map_err(ExportError::write(path))
}

/// Returns whether ffmpeg can be run. The result is cached for the life of the process.
#[must_use]
pub fn has_ffmpeg() -> bool {
    static IS_AVAILABLE: OnceLock<bool> = OnceLock::new();
    *IS_AVAILABLE.get_or_init(ffmpeg::is_available)
}

/// Runs ffmpeg for one output file, and turns its messages into errors.
struct FfmpegJob<'a> {
    /// Final path of the file.
    path: &'a Path,
    /// Temporary path of the file until it is verified.
    temporary: &'a Path,
    progress: &'a dyn Progress,
}

impl FfmpegJob<'_> {
    /// Runs ffmpeg and turns every unsuccessful end into an error.
    fn run(
        &self,
        command: Command,
        feed: impl FnOnce(ChildStdin),
    ) -> Result<FfmpegOutcome, ExportError> {
        let ended = match ffmpeg::run(command, self.progress, feed) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(ExportError::NoFfmpeg);
            }
            Err(error) => return Err(self.ffmpeg_error(&error.to_string())),
            Ok(ended) => ended,
        };
        match &ended.messages {
            _ if self.progress.is_cancelled() => Err(Cancelled.into()),
            _ if ended.status.success() => Ok(ended),
            words if words.report_full_disk => Err(self.disk_full_error()),
            words if words.last.is_empty() => Err(self.ffmpeg_error(&ended.status.to_string())),
            words => Err(self.ffmpeg_error(&words.last)),
        }
    }

    /// Verifies the file independently of the exit status of the encoding run: has ffmpeg decode
    /// it, and counts the frames. `words` are the messages of the encoding run.
    fn check(&self, count: usize, words: &FfmpegMessages) -> Result<(), ExportError> {
        self.progress.report(CHECKING_STAGE, DRAWN_FRACTION);
        let reason = match self.run(ffmpeg::decode_command(self.temporary), drop) {
            Ok(decoding) if decoding.frames == count => return Ok(()),
            Ok(decoding) => format!("it has {} of {count} frames", decoding.frames),
            Err(ExportError::Ffmpeg { last_line, .. }) => last_line,
            Err(error) => return Err(error),
        };
        Err(match words.last.as_str() {
            _ if words.report_full_disk => self.disk_full_error(),
            "" => ExportError::corrupt(self.path, reason),
            last => {
                let last = self.with_final_path(last);
                ExportError::corrupt(self.path, format!("{reason} (ffmpeg said: {last})"))
            }
        })
    }

    /// Creates the error for a full disk.
    fn disk_full_error(&self) -> ExportError {
        ExportError::write(self.path)(io::ErrorKind::StorageFull.into())
    }

    /// Creates the error that quotes a message of ffmpeg.
    fn ffmpeg_error(&self, words: &str) -> ExportError {
        ExportError::Ffmpeg {
            path: self.path.to_owned(),
            last_line: self.with_final_path(words),
        }
    }

    /// Replaces the temporary path in a message by the final one, which the user knows.
    fn with_final_path(&self, words: &str) -> String {
        let [temporary, path] = [self.temporary, self.path].map(|path| path.display().to_string());
        words.replace(&temporary, &path)
    }
}
