//! What can go wrong while pictures and films are written.

use std::io;
use std::path::PathBuf;

use crate::progress::Cancelled;

/// Why an export did not come to its end. Nothing half-written is left.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The operating system refused.
    #[error("cannot write `{}`: {source}; choose a folder that exists and that you may write to", .path.display())]
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
    /// GIF counts hundredths of a second, and readers slow one of them down to
    /// ten.
    #[error(
        "a GIF cannot run at {0} frames a second: choose 50 or fewer, or write an .apng or .mp4"
    )]
    GifRate(f64),
    /// A kind of film without transparency was asked for a transparent ground.
    #[error("an MP4 cannot be transparent: choose a coloured ground, or write an .apng")]
    Mp4Transparent,
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

    /// An encoder refused to write `path`.
    pub(super) fn encode<E: std::fmt::Display>(path: impl Into<PathBuf>) -> impl FnOnce(E) -> Self {
        let path = path.into();
        move |error| Self::Encode {
            path,
            reason: error.to_string(),
        }
    }
}
