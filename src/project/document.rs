//! Data of a project file, exactly as it is serialised.

use super::map::MapSettings;
use super::segment_settings::SegmentRecord;
use super::title::title_of;
use crate::content::ContentKind;
use crate::design::{DesignSource, ImportOptions};
use crate::geometry::Similarity;
use crate::io::path_text;
use crate::transition::{
    CachedMatch, DesignFit, Timing, TransitionOptions, TransitionStop, TransitionStyle,
};
use crate::warp::WarpKind;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Newest version of the format. Older versions can be read, newer ones are errors. A project is
/// written in the oldest version that can represent it.
pub const FORMAT_VERSION: u32 = 2;

/// Format version that suffices for a film from one design to another, without a map and without
/// pauses or durations at its stops.
const PAIR_VERSION: u32 = 1;

/// Contents of a `.morph` project file.
///
/// ```
/// use morphospace::project::Project;
/// let project = Project::parse(r#"
/// version = 1
/// [[designs]]
/// path = "a.svg"
/// [[designs]]
/// path = "b.svg"
/// "#)?;
/// assert_eq!(Project::parse(&project.to_toml()?)?, project);
/// # Ok::<(), morphospace::project::ProjectError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct Project {
    /// Version of the format in which the file is written.
    pub version: u32,
    /// Title of the project.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// One sentence about the project.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Warp: a row of the table of methods in the crate documentation. `None` chooses the warp that
    /// suits the designs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warp: Option<WarpKind>,
    /// Content: a column of the table of methods in the crate documentation. `None` chooses the
    /// content that suits the designs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub content: Option<ContentKind>,
    /// Alignment of the other designs with the first.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fit: DesignFit,
    /// Designs, at least two, in the order in which the film shows them.
    pub designs: Vec<DesignEntry>,
    /// Whether the film continues from the last design back to the first. Stored from format
    /// version 2 on.
    #[serde(default, skip_serializing_if = "is_default")]
    pub closed: bool,
    /// Settings of each segment between two consecutive designs; empty for two designs. If the list
    /// is shorter than the number of segments, the last segments have default settings. Stored from
    /// format version 2 on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legs: Vec<SegmentRecord>,
    /// Map of all designs. Stored from format version 2 on.
    #[serde(default, skip_serializing_if = "is_default")]
    pub map: MapSettings,
    /// Options of all methods; their keys are at the top level of the file.
    // Deserialising through `flatten` would accept unknown keys and lose line numbers.
    #[serde(flatten, skip_deserializing)]
    pub options: TransitionOptions,
    /// Duration, easing and playback.
    #[serde(default)]
    pub timing: Timing,
    /// Colours of the designs and of the background, and whether joints of trusses are drawn.
    #[serde(default)]
    pub style: TransitionStyle,
    /// Moments of the film with a name, a note or a pause.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stops: Vec<TransitionStop>,
    /// Match and motion as they were solved when the project was saved, to be reused on opening it.
    #[serde(default, skip_serializing_if = "CachedMatch::is_none")]
    pub found: CachedMatch,
}

/// One design of a project.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DesignEntry {
    /// Path of the file relative to the project file, with `/` between folders; or an element of a
    /// drawing, or text, in the forms of [`DesignSource`]. A path that is not UTF-8 is stored
    /// percent-encoded, such as `file:caf%E9.svg`.
    #[serde(with = "path_text")]
    pub path: PathBuf,
    /// Name of the design; if empty, the file name is used.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Options for reading the file.
    #[serde(default, skip_serializing_if = "is_default")]
    pub import: ImportOptions,
    /// Similarity transform that is applied to the design about its own centre, after `fit`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub placement: Similarity,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl DesignEntry {
    /// Creates an entry with default options.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            name: String::new(),
            import: ImportOptions::default(),
            placement: Similarity::default(),
        }
    }

    /// Returns the name of the design; if it is empty, the file name without its extension.
    #[must_use]
    pub fn display_name(&self) -> String {
        match self.name.as_str() {
            "" => {
                let stem = self.path.file_stem().unwrap_or_default();
                stem.to_string_lossy().into_owned()
            }
            name => name.to_owned(),
        }
    }
}

impl Project {
    /// File extension of projects, without the dot.
    pub const EXTENSION: &'static str = "morph";

    /// Returns whether a path has the extension of project files, in upper or lower case.
    #[must_use]
    pub fn has_document_extension(path: &Path) -> bool {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(Self::EXTENSION))
    }

    /// Creates a project of two files with default options; the paths are stored as given.
    #[must_use]
    pub fn from_pair(source: impl Into<PathBuf>, target: impl Into<PathBuf>) -> Self {
        Self::from_paths([source.into(), target.into()])
    }

    /// Creates a project of at least two files with default options; the paths are stored as given.
    ///
    /// The film goes through all designs in order and pauses at each.
    #[must_use]
    pub fn from_paths<P: Into<PathBuf>>(designs: impl IntoIterator<Item = P>) -> Self {
        let designs: Vec<_> = designs.into_iter().map(DesignEntry::new).collect();
        // The names are taken from the paths, because the designs have not been read yet.
        let names: Vec<_> = designs
            .iter()
            .map(|d| DesignSource::from_path(&d.path).name())
            .collect();
        let mut project = Self::with_defaults(title_of(&names), designs);
        let segments = project.segment_count() as f64;
        project.timing.to = segments;
        project.timing.duration_secs *= segments;
        project.with_pauses_at_designs()
    }

    fn with_defaults(title: String, designs: Vec<DesignEntry>) -> Self {
        Self {
            version: PAIR_VERSION,
            title,
            description: String::new(),
            warp: None,
            content: None,
            fit: DesignFit::default(),
            designs,
            closed: false,
            legs: Vec::new(),
            map: MapSettings::default(),
            options: TransitionOptions::default(),
            timing: Timing::default(),
            style: TransitionStyle::default(),
            stops: Vec::new(),
            found: CachedMatch::default(),
        }
    }

    /// Returns the oldest version of the format that can represent the project.
    pub(super) fn needed_version(&self) -> u32 {
        let has_times =
            |stop: &TransitionStop| stop.hold_secs != 0.0 || stop.duration_secs.is_some();
        let has_map = self.map != MapSettings::default();
        if self.is_sequence() || has_map || self.stops.iter().any(has_times) {
            FORMAT_VERSION
        } else {
            PAIR_VERSION
        }
    }
}
