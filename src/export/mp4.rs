//! A film as an MP4, by the ffmpeg on the path, which is fed raw frames.
//!
//! Guarantees: H.264-friendly 4:2:0 colour at even sizes, in the BT.709 colours
//! that players assume; every frame of the film at its rate; no file unless
//! ffmpeg ended well, the file has every frame, and ffmpeg can decode it: on a
//! full disk ffmpeg (5.1) ends well, too. Which encoder and how small is ffmpeg's
//! affair.

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

/// Writes the film; the camera's size must be even on both sides
/// ([`PixelSize::to_even`](super::PixelSize::to_even)), or ffmpeg refuses it.
///
/// # Errors
/// [`ExportError`] where the ground is transparent, there is no ffmpeg, it
/// fails or writes less than it was given, or nobody wants the film any more.
pub fn write_mp4(
    camera: &Camera,
    film: &FilmSpec,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    if camera.ground.is_none() {
        return Err(ExportError::Mp4Transparent);
    }
    // The folder is tried before ffmpeg is.
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let job = FfmpegJob {
        path,
        temporary: file.temporary_path(),
        progress,
    };
    let command = ffmpeg::encode_command(camera.view.size(), film.fps(), job.temporary);
    let mut fed = Ok(());
    let words = job.run(command, |mut stdin| {
        fed = camera.shoot_runs(
            &film.runs(),
            DRAWING_STAGE,
            &ProgressSpan::new(progress, 0.0, DRAWN_FRACTION),
            |drawing| Ok(planes(&rasterise(&drawing))),
            |run, bytes| {
                // ffmpeg knows a rate and no holds: a run goes in frame by frame.
                let feed = |_| stdin.write_all(&bytes);
                (0..run.count)
                    .try_for_each(feed)
                    .map_err(ExportError::write(path))
            },
        );
    })?;
    job.check(film.times().len(), &words)?;
    fed?;
    file.commit().map_err(ExportError::write(path))
}

/// The brightness of all pixels, and then the two colours of each four, in the BT.709
/// range of films. ffmpeg would do the same, alone and after twice as many bytes have
/// gone through a pipe: of 300 frames in Full HD it took 7 s of the processor, with
/// this 4.5.
fn planes(image: &RgbaImage) -> Vec<u8> {
    let (width, height) = image.dimensions();
    let mut planes = YuvPlanarImageMut::alloc(width, height, YuvChromaSubsampling::Yuv420);
    let (range, matrix) = (YuvRange::Limited, YuvStandardMatrix::Bt709);
    let mode = YuvConversionMode::Balanced;
    let stride = 4 * width;
    // Refused only where the sizes do not fit, and they are of one picture.
    let made = rgba_to_yuv420(&mut planes, image.as_raw(), stride, range, matrix, mode);
    debug_assert!(made.is_ok());
    let planes = [planes.y_plane, planes.u_plane, planes.v_plane];
    planes.each_ref().map(|plane| plane.borrow()).concat()
}

/// Whether there is an ffmpeg to write MP4s with; it is looked for once.
#[must_use]
pub fn has_ffmpeg() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(ffmpeg::is_available)
}

/// What ffmpeg has to do with one file.
struct FfmpegJob<'a> {
    /// What it is going to be called.
    path: &'a Path,
    /// What it is called until it is whole.
    temporary: &'a Path,
    progress: &'a dyn Progress,
}

impl FfmpegJob<'_> {
    /// Runs ffmpeg to a good end.
    fn run(
        &self,
        command: Command,
        feed: impl FnOnce(ChildStdin),
    ) -> Result<FfmpegMessages, ExportError> {
        let ended = match ffmpeg::run(command, self.progress, feed) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(ExportError::NoFfmpeg);
            }
            Err(error) => return Err(self.failed(&error.to_string())),
            Ok(ended) => ended,
        };
        match ended.words {
            _ if self.progress.is_cancelled() => Err(Cancelled.into()),
            words if ended.status.success() => Ok(words),
            words if words.tell_of_full_disk => Err(self.full()),
            words if words.last.is_empty() => Err(self.failed(&ended.status.to_string())),
            words => Err(self.failed(&words.last)),
        }
    }

    /// Looks at what is there: `words` of whoever wrote it prove nothing.
    fn check(&self, count: usize, words: &FfmpegMessages) -> Result<(), ExportError> {
        self.progress.report(CHECKING_STAGE, DRAWN_FRACTION);
        let reason =
            match File::open(self.temporary).and_then(|mut file| boxes::frame_count(&mut file)) {
                // Each is in the file; whether it is a picture only a decoder tells.
                Ok(found) if found == count => {
                    let decoding = ffmpeg::decode_command(self.temporary);
                    return self.run(decoding, drop).map(drop);
                }
                Ok(found) => format!("{found} of {count} frames are there"),
                Err(error) => error.to_string(),
            };
        Err(match words.last.as_str() {
            _ if words.tell_of_full_disk => self.full(),
            "" => ExportError::not_whole(self.path, reason),
            last => {
                let last = self.renamed(last);
                ExportError::not_whole(self.path, format!("{reason} (ffmpeg said: {last})"))
            }
        })
    }

    fn full(&self) -> ExportError {
        ExportError::write(self.path)(io::ErrorKind::StorageFull.into())
    }

    fn failed(&self, words: &str) -> ExportError {
        ExportError::Ffmpeg {
            path: self.path.to_owned(),
            last_line: self.renamed(words),
        }
    }

    /// Words with the name that the user knows.
    fn renamed(&self, words: &str) -> String {
        let [temporary, path] = [self.temporary, self.path].map(|path| path.display().to_string());
        words.replace(&temporary, &path)
    }
}
