//! What can go wrong while pictures and films are written.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use crate::io::atomic_file::refusal;
use crate::work::progress::Cancelled;

/// Why an export did not come to its end. Nothing half-written is left.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The operating system refused.
    #[error("cannot write `{}`: {}", .path.display(), refusal(.source))]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A picture could not be encoded.
    #[error("cannot encode `{}`: {reason}; try a smaller size or another format", .path.display())]
    Encode {
        /// The file that was to be written.
        path: PathBuf,
        /// The encoder's reason.
        reason: String,
    },
    /// What is there is not what was to be written.
    #[error(
        "`{}` did not come out whole: {reason}; see whether the disk is full or broken, and write it once more",
        .path.display()
    )]
    NotWhole {
        /// The file that was to be written.
        path: PathBuf,
        /// What is wrong with what was written.
        reason: String,
    },
    /// GIF counts hundredths of a second, and readers slow one of them down to
    /// ten.
    #[error(
        "a GIF cannot run at {0} frames a second: choose 50 or fewer, or write an .apng or .mp4"
    )]
    GifRate(f64),
    /// A kind of film without transparency was asked for a transparent ground.
    #[error("an MP4 cannot be transparent: choose a coloured ground, or write an .apng")]
    Mp4Transparent,
    /// Pictures were to leave as outlines.
    #[error(
        "pictures have no outlines that could move: write a .gif, .apng or .mp4, or numbered .png"
    )]
    NoOutlines,
    /// No ffmpeg on the path.
    #[error(
        "an MP4 needs ffmpeg, which is not on the path: install it from your system's packages or ffmpeg.org, or write a .gif or .apng"
    )]
    NoFfmpeg,
    /// ffmpeg ran and failed.
    #[error(
        "ffmpeg could not write `{}`: {last_line}; try another size or rate, or write a .gif or .apng",
        .path.display()
    )]
    Ffmpeg {
        /// The file that was to be written.
        path: PathBuf,
        /// The last line that it said.
        last_line: String,
    },
    /// Nobody wanted the result any more.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl ExportError {
    /// The system refused to write `path`.
    pub(super) fn write(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::Write { path, source }
    }

    /// An encoder refused to write `path`, or the system did.
    pub(super) fn encode<E: Into<EncodeFailure>>(
        path: impl Into<PathBuf>,
    ) -> impl FnOnce(E) -> Self {
        let path = path.into();
        move |error| match error.into() {
            EncodeFailure::BySystem(source) => Self::Write { path, source },
            EncodeFailure::ByEncoder(reason) => Self::Encode { path, reason },
        }
    }

    /// What was written to `path` is not what belongs there.
    pub(super) fn not_whole(path: &Path, reason: impl Display) -> Self {
        Self::NotWhole {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Who did not want to write: the libraries pass the system's reasons on among
/// their own.
pub(super) enum EncodeFailure {
    BySystem(io::Error),
    ByEncoder(String),
}

impl From<gif::EncodingError> for EncodeFailure {
    fn from(error: gif::EncodingError) -> Self {
        match error {
            gif::EncodingError::Io(error) => Self::BySystem(error),
            error => Self::ByEncoder(error.to_string()),
        }
    }
}

impl From<png::EncodingError> for EncodeFailure {
    fn from(error: png::EncodingError) -> Self {
        match error {
            png::EncodingError::IoError(error) => Self::BySystem(error),
            error => Self::ByEncoder(error.to_string()),
        }
    }
}

impl From<image::ImageError> for EncodeFailure {
    fn from(error: image::ImageError) -> Self {
        // Its pictures are encoded in memory.
        Self::ByEncoder(error.to_string())
    }
}
