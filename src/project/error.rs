//! Errors of reading, checking, loading and writing project files.

use super::document::FORMAT_VERSION;
use super::map::MapError;
use crate::content::{ColourMixError, FieldBlendError};
use crate::correspondence::MatchSettingsError;
use crate::design::ImportError;
use crate::geometry::SimilarityError;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;
use crate::mesh::TooManyVertices;
use crate::space::SpaceError;
use crate::transition::{BuildError, PaintLayerOptionsError, PartTimeError, TimingError};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Error while reading, loading or writing a project.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// An error together with the file in which it occurred.
    #[error("{}", SanitizedLine(format_args!("{}: {error}", file.display())))]
    InFile {
        /// The project file.
        file: PathBuf,
        /// The error in that file.
        error: Box<ProjectError>,
    },
    /// The file could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The operating system refused to write the file.
    #[error("the project cannot be written: {0}")]
    Unwritable(String),
    /// A file that must not be replaced has the name of the new file.
    #[error("{}", SanitizedLine(format_args!("`{}` already exists: choose another name", .0.display())))]
    AlreadyExists(PathBuf),
    /// The file is not UTF-8 text.
    #[error("this is not a text file; a .morph project is TOML in UTF-8")]
    NotText,
    /// A key or value is invalid.
    #[error("line {line}: {}", SanitizedLine(message))]
    Syntax {
        /// Line of the key or value, from 1.
        line: usize,
        /// Message of the parser.
        message: String,
    },
    /// The version is newer than this program supports.
    #[error(
        "line {line}: the project has version {version}, but this program reads versions up to {}; update the program",
        FORMAT_VERSION
    )]
    NewerVersion {
        /// Line of the version number, from 1.
        line: usize,
        /// Version of the file.
        version: u64,
    },
    /// The version is 0.
    #[error(
        "there is no version 0 of this format; write version = {}",
        FORMAT_VERSION
    )]
    VersionZero,
    /// Fewer than two designs.
    #[error("a project needs at least two designs, but has {0}; add [[designs]] with a path")]
    TooFewDesigns(usize),
    /// There are more segment settings than segments.
    #[error(
        "the project has {has} [[legs]], but its designs allow only {may_have} (a pair has none); remove the others"
    )]
    TooManySegments {
        /// Number of segment settings.
        has: usize,
        /// Maximum number of segment settings; 0 for a project of two designs.
        may_have: usize,
    },
    /// Match settings are given both at the top level and in segments.
    #[error(
        "match and parts are at the top level although there are [[legs]]; move them into the first of these"
    )]
    AmbiguousMatch,
    /// The similarity transform that places a design is invalid.
    #[error(transparent)]
    Placement(#[from] SimilarityError),
    /// A parameter of the blend of distance fields, ε or the threshold, is not a permitted number.
    #[error(transparent)]
    Blend(#[from] FieldBlendError),
    /// The interval of t in which colours are mixed is invalid.
    #[error(transparent)]
    Colours(#[from] ColourMixError),
    /// A pin, line or other match setting has an invalid position.
    #[error(transparent)]
    MatchPlace(#[from] MatchSettingsError),
    /// The mesh would have too many vertices after subdivision.
    #[error(transparent)]
    Subdivisions(#[from] TooManyVertices),
    /// The timing is invalid.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// The timing of a part is invalid.
    #[error(transparent)]
    PartTime(#[from] PartTimeError),
    /// The time at which paint layers are reordered is invalid.
    #[error(transparent)]
    PaintLayers(#[from] PaintLayerOptionsError),
    /// The map is invalid.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The design space could not be built.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// A design could not be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The transition could not be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A value cannot be represented in TOML.
    #[error("the project cannot be written ({0}); correct that value")]
    NotSerializable(String),
    /// There is no bundled project with the requested name.
    #[error(
        "the gallery has no project \"{}\"; it has {known}",
        SanitizedLine(name)
    )]
    NotInGallery {
        /// Requested name.
        name: String,
        /// Names of all bundled projects.
        known: String,
    },
}

impl ProjectError {
    /// Wraps the error together with the file in which it occurred.
    pub(super) fn in_file(self, file: &Path) -> Self {
        Self::InFile {
            file: file.to_owned(),
            error: Box::new(self),
        }
    }

    /// Creates a syntax error from an error of the TOML parser.
    pub(super) fn syntax(text: &str, error: &toml::de::Error) -> Self {
        let message = error.message().replace('\n', "; ");
        Self::Syntax {
            line: error.span().map_or(1, |span| line_of(text, span.start)),
            message: message.trim_end_matches("; ").to_owned(),
        }
    }

    /// Creates the error for an unknown top-level key. `valid` lists the valid keys: those of the
    /// project, then those of the transition options.
    pub(super) fn unknown_key(
        text: &str,
        key: &toml::Spanned<Cow<'_, str>>,
        valid: [&[&str]; 2],
    ) -> Self {
        Self::Syntax {
            line: line_of(text, key.span().start),
            message: format!(
                "unknown key \"{}\", expected one of {}",
                key.get_ref(),
                valid.concat().join(", ")
            ),
        }
    }

    /// Creates the error for a newer version found at a byte of the text.
    pub(super) fn newer(text: &str, byte: usize, version: u64) -> Self {
        Self::NewerVersion {
            line: line_of(text, byte),
            version,
        }
    }
}

/// Returns the number, from 1, of the line that contains the given byte of the text.
fn line_of(text: &str, byte: usize) -> usize {
    let before = text.as_bytes().iter().take(byte);
    1 + before.filter(|&&b| b == b'\n').count()
}
