//! Writes a film as an MP4 by feeding raw frames to the ffmpeg on the PATH.
//!
//! Guarantees: 4:2:0 chroma, which requires an even width and height, and BT.709 colours, which
//! players assume; all frames of the film at its frame rate. The file replaces an earlier one only
//! if ffmpeg succeeded, the file contains all frames, and ffmpeg can decode it. The exit status
//! alone is not sufficient, because ffmpeg 5.1 reports success even on a full disk. ffmpeg chooses
//! the encoder and determines the file size.

mod boxes;
mod ffmpeg;

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::process::{ChildStdin, Command};
use std::sync::OnceLock;

use image::RgbaImage;
use yuv::{
    YuvChromaSubsampling, YuvConversionMode, YuvPlanarImageMut, YuvRange, YuvStandardMatrix,
    rgba_to_yuv420,
};

use crate::io::atomic_file::AtomicFile;
use crate::work::progress::{Cancelled, Progress, ProgressSpan};

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::raster::rasterise;
use super::readback::{CHECKING_STAGE, DRAWN_FRACTION};
use ffmpeg::FfmpegMessages;

/// Writes the film to `path`, and verifies the file before it replaces an earlier one. Both sides
/// of the camera's image must be even ([`PixelSize::to_even`](super::PixelSize::to_even)), or
/// ffmpeg refuses it.
///
/// # Errors
/// [`ExportError`] if the background is transparent, ffmpeg is missing, fails or writes fewer
/// frames than it received, or the export is cancelled.
pub fn write_mp4(
    camera: &Camera,
    film: &FilmSpec,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    if camera.ground.is_none() {
        return Err(ExportError::Mp4Transparent);
    }
    // The file is created before ffmpeg is started, so that an unwritable folder is reported first.
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let job = FfmpegJob {
        path,
        temporary: file.temporary_path(),
        progress,
    };
    let command = ffmpeg::encode_command(camera.view.size(), film.fps(), job.temporary);
    let mut feeding = Ok(());
    let words = job.run(command, |mut stdin| {
        feeding = camera.draw_runs(
            &film.runs(),
            DRAWING_STAGE,
            &ProgressSpan::new(progress, 0.0, DRAWN_FRACTION),
            |drawing| Ok(planes(&rasterise(&drawing))),
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
    job.check(film.times().len(), &words)?;
    feeding?;
    file.commit().map_err(ExportError::write(path))
}

/// Converts an image to planar 4:2:0 YUV in limited-range BT.709: the luma of all pixels, then two
/// chroma samples for each 2 × 2 pixels. ffmpeg could convert instead, but on a single thread and
/// after at least twice as many bytes have passed through the pipe.
fn planes(image: &RgbaImage) -> Vec<u8> {
    let (width, height) = image.dimensions();
    let mut planes = YuvPlanarImageMut::alloc(width, height, YuvChromaSubsampling::Yuv420);
    let (range, matrix) = (YuvRange::Limited, YuvStandardMatrix::Bt709);
    let mode = YuvConversionMode::Balanced;
    let stride = 4 * width;
    // The conversion fails only if the buffer sizes do not match, and they come from one image.
    let conversion = rgba_to_yuv420(&mut planes, image.as_raw(), stride, range, matrix, mode);
    debug_assert!(conversion.is_ok());
    let planes = [planes.y_plane, planes.u_plane, planes.v_plane];
    planes.each_ref().map(|plane| plane.borrow()).concat()
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
    ) -> Result<FfmpegMessages, ExportError> {
        let ended = match ffmpeg::run(command, self.progress, feed) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(ExportError::NoFfmpeg);
            }
            Err(error) => return Err(self.ffmpeg_error(&error.to_string())),
            Ok(ended) => ended,
        };
        match ended.messages {
            _ if self.progress.is_cancelled() => Err(Cancelled.into()),
            words if ended.status.success() => Ok(words),
            words if words.report_full_disk => Err(self.disk_full_error()),
            words if words.last.is_empty() => Err(self.ffmpeg_error(&ended.status.to_string())),
            words => Err(self.ffmpeg_error(&words.last)),
        }
    }

    /// Verifies the file independently of the exit status: counts its frames and then has ffmpeg
    /// decode it. `words` are the messages of the encoding run.
    fn check(&self, count: usize, words: &FfmpegMessages) -> Result<(), ExportError> {
        self.progress.report(CHECKING_STAGE, DRAWN_FRACTION);
        let reason =
            match File::open(self.temporary).and_then(|mut file| boxes::frame_count(&mut file)) {
                // All frames are present, but only a decoder can find out whether they are valid
                // images.
                Ok(frame_count) if frame_count == count => {
                    let decoding = ffmpeg::decode_command(self.temporary);
                    return self.run(decoding, drop).map(drop);
                }
                Ok(frame_count) => format!("it has {frame_count} of {count} frames"),
                Err(error) => error.to_string(),
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
