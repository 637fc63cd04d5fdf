//! Errors of image and film export, and the conversion from the errors of the encoder libraries.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use crate::io::atomic_file::write_error_message;
use crate::work::progress::Cancelled;

/// Reason why an export failed. Partly written files have been removed; finished frames of a
/// numbered sequence remain.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The operating system refused to write.
    #[error("cannot write `{}`: {}", .path.display(), write_error_message(.source))]
    Write {
        /// Path of the output file.
        path: PathBuf,
        /// Reason given by the operating system.
        source: io::Error,
    },
    /// An encoder rejected the image.
    #[error("cannot encode `{}`: {reason}; try a smaller size or another format", .path.display())]
    Encode {
        /// Path of the output file.
        path: PathBuf,
        /// Reason given by the encoder.
        reason: String,
    },
    /// Reading the written file back showed that it is damaged or incomplete.
    #[error(
        "`{}` was not written completely: {reason}; check the disk for free space and errors, then export again",
        .path.display()
    )]
    Corrupt {
        /// Path of the output file.
        path: PathBuf,
        /// Defect found when the file was read back.
        reason: String,
    },
    /// The frame rate is higher than GIF players support. GIF delays are in hundredths of a second,
    /// and players replace delays below two hundredths by ten hundredths.
    #[error(
        "a GIF cannot play {0} frames per second: choose 50 or fewer, or write an .apng or .mp4"
    )]
    GifRate(f64),
    /// An MP4, which has no transparency, was requested with a transparent background.
    #[error(
        "an MP4 cannot be transparent: write a .webm or .mov video, an .apng or numbered .png images, or choose a background colour"
    )]
    Mp4Transparent,
    /// A vector format was requested for raster images.
    #[error(
        "raster images have no outlines, which this format needs: write a .gif, .apng or .mp4, or numbered .png"
    )]
    NoOutlines,
    /// No ffmpeg program was found on the PATH.
    #[error(
        "videos need ffmpeg, which was not found on the PATH: install it from your system's packages or ffmpeg.org, or write a .gif or .apng"
    )]
    NoFfmpeg,
    /// ffmpeg started and failed.
    #[error(
        "ffmpeg could not write `{}`: {last_line}; try another size or frame rate, or write a .gif or .apng",
        .path.display()
    )]
    Ffmpeg {
        /// Path of the output file.
        path: PathBuf,
        /// Last line of the error output of ffmpeg.
        last_line: String,
    },
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl ExportError {
    /// Returns a function that wraps an I/O error for `path`.
    pub(super) fn write(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::Write { path, source }
    }

    /// Returns a function that wraps an encoder error for `path`, and separates I/O errors from
    /// those of the encoder itself.
    pub(super) fn encode<E: Into<EncodeFailure>>(
        path: impl Into<PathBuf>,
    ) -> impl FnOnce(E) -> Self {
        let path = path.into();
        move |error| match error.into() {
            EncodeFailure::Io(source) => Self::Write { path, source },
            EncodeFailure::Encoder(reason) => Self::Encode { path, reason },
        }
    }

    /// Creates the error for a file at `path` that failed verification for the given reason.
    pub(super) fn corrupt(path: &Path, reason: impl Display) -> Self {
        Self::Corrupt {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Error of an encoder library, split by cause: these libraries report I/O errors among their own
/// errors.
pub(super) enum EncodeFailure {
    Io(io::Error),
    Encoder(String),
}

impl From<gif::EncodingError> for EncodeFailure {
    fn from(error: gif::EncodingError) -> Self {
        match error {
            gif::EncodingError::Io(error) => Self::Io(error),
            error => Self::Encoder(error.to_string()),
        }
    }
}

impl From<png::EncodingError> for EncodeFailure {
    fn from(error: png::EncodingError) -> Self {
        match error {
            png::EncodingError::IoError(error) => Self::Io(error),
            error => Self::Encoder(error.to_string()),
        }
    }
}

impl From<image::ImageError> for EncodeFailure {
    fn from(error: image::ImageError) -> Self {
        // These images are encoded in memory, so there is no I/O error to separate.
        Self::Encoder(error.to_string())
    }
}
