//! What can be wrong with a project.

use super::document::FORMAT_VERSION;
use super::map::MapError;
use crate::content::{ColourMixError, FieldPairError};
use crate::correspondence::MatchPlaceError;
use crate::design::ImportError;
use crate::geometry::SimilarityError;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;
use crate::mesh::TooManyVertices;
use crate::space::SpaceError;
use crate::transition::{BuildError, PaintLayerOptionsError, PartTimeError, TimingError};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Why a project could not be read, written or loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// What is wrong, and in which file.
    #[error("{}", SanitizedLine(format_args!("{}: {error}", file.display())))]
    InFile {
        /// The document.
        file: PathBuf,
        /// What is wrong with it.
        error: Box<ProjectError>,
    },
    /// The file is not there, is no file, or is too large.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The system refused to write it.
    #[error("the project cannot be written: {0}")]
    Unwritable(String),
    /// The bytes are no text.
    #[error("this is not a text file; a .morph document is TOML in UTF-8")]
    NotText,
    /// A key or value is wrong.
    #[error("line {line}: {}", SanitizedLine(message))]
    Syntax {
        /// Counted from 1.
        line: usize,
        /// In the parser's words.
        message: String,
    },
    /// The version is from the future.
    #[error(
        "line {line}: the document has version {version}, this program reads up to {}; update the program",
        FORMAT_VERSION
    )]
    NewerVersion {
        /// Counted from 1.
        line: usize,
        /// What the document says.
        version: u64,
    },
    /// There is no version 0.
    #[error(
        "there is no version 0 of this format; write version = {}",
        FORMAT_VERSION
    )]
    VersionZero,
    /// Fewer than two designs.
    #[error("a transition needs two designs, the document lists {0}; add [[designs]] with a path")]
    TooFewDesigns(usize),
    /// There are more legs than ways from one design to the next.
    #[error(
        "the document has {has} [[legs]], and its designs have {may_have} (a pair has none): take the others out"
    )]
    TooManyLegs {
        /// How many it has.
        has: usize,
        /// How many it may have; a pair has none.
        may_have: usize,
    },
    /// Of many designs it is not said which two a match is for.
    #[error(
        "match and parts stand at the top and there are [[legs]]: move them into the first of these"
    )]
    MatchOfNoLeg,
    /// A placement is no similarity.
    #[error(transparent)]
    Placement(#[from] SimilarityError),
    /// ε or the threshold is out of range.
    #[error(transparent)]
    Blend(#[from] FieldPairError),
    /// The span in which colours change is none.
    #[error(transparent)]
    Colours(#[from] ColourMixError),
    /// A pin or the like is nowhere.
    #[error(transparent)]
    Place(#[from] MatchPlaceError),
    /// There are too many subdivisions.
    #[error(transparent)]
    Subdivisions(#[from] TooManyVertices),
    /// The timing gives no pass.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// A part's own time is none.
    #[error(transparent)]
    PartTime(#[from] PartTimeError),
    /// Coats change places at no time.
    #[error(transparent)]
    Coats(#[from] PaintLayerOptionsError),
    /// The map is none.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The designs span no space.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// A design could not be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The designs do not go together.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A value cannot be written.
    #[error("the project cannot be written ({0}); correct that value")]
    Write(String),
    /// No bundled project of that name.
    #[error(
        "the gallery has no project \"{}\"; it has {known}",
        SanitizedLine(name)
    )]
    NotInGallery {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
}

impl ProjectError {
    pub(super) fn in_file(self, file: &Path) -> Self {
        Self::InFile {
            file: file.to_owned(),
            error: Box::new(self),
        }
    }

    pub(super) fn syntax(text: &str, error: &toml::de::Error) -> Self {
        let message = error.message().replace('\n', "; ");
        Self::Syntax {
            line: error.span().map_or(1, |span| line_of(text, span.start)),
            message: message.trim_end_matches("; ").to_owned(),
        }
    }

    pub(super) fn unknown_key(
        text: &str,
        key: &toml::Spanned<Cow<'_, str>>,
        known: [&[&str]; 2],
    ) -> Self {
        Self::Syntax {
            line: line_of(text, key.span().start),
            message: format!(
                "unknown key \"{}\", expected one of {}",
                key.get_ref(),
                known.concat().join(", ")
            ),
        }
    }

    pub(super) fn newer(text: &str, at: usize, version: u64) -> Self {
        Self::NewerVersion {
            line: line_of(text, at),
            version,
        }
    }
}

fn line_of(text: &str, byte: usize) -> usize {
    let before = text.as_bytes().iter().take(byte);
    1 + before.filter(|&&b| b == b'\n').count()
}
