//! The document itself, as it stands in the file.

use super::map::MapSettings;
use super::segment_settings::SegmentRecord;
use super::title::title_of;
use crate::content::ContentKind;
use crate::design::{DesignSource, ImportOptions};
use crate::geometry::Similarity;
use crate::transition::{
    CachedMatch, DesignFit, Timing, TransitionOptions, TransitionStop, TransitionStyle,
};
use crate::warp::WarpKind;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The newest version: older ones are read, newer ones refused. A document is written
/// in the oldest that can say it.
pub const FORMAT_VERSION: u32 = 2;

/// What two designs need.
const OF_A_PAIR: u32 = 1;

/// A `.morph` document.
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
    /// The version of the format.
    pub version: u32,
    /// What the transition is called.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// A sentence about it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// The row of the table; where it is not given, the method that suits the
    /// designs is chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warp: Option<WarpKind>,
    /// The column of the table, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub content: Option<ContentKind>,
    /// How the target is fitted to the source.
    #[serde(default)]
    pub fit: DesignFit,
    /// The given forms, at least two, in the order in which the film goes through them.
    pub designs: Vec<DesignEntry>,
    /// Whether the last one leads back to the first. From version 2 on.
    #[serde(default, skip_serializing_if = "is_default")]
    pub closed: bool,
    /// Where there are more than two: what belongs to the way from each to the next, in
    /// order; what is missing at the end has nothing of its own. From version 2 on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legs: Vec<SegmentRecord>,
    /// The map of all designs. From version 2 on.
    #[serde(default, skip_serializing_if = "is_default")]
    pub map: MapSettings,
    /// The options of all methods, whose keys stand beside the others in the
    /// file.
    // Reading through `flatten` would lose unknown keys and lines.
    #[serde(flatten, skip_deserializing)]
    pub options: TransitionOptions,
    /// How it runs over time.
    #[serde(default)]
    pub timing: Timing,
    /// How it is painted.
    #[serde(default)]
    pub style: TransitionStyle,
    /// Named places on the way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stops: Vec<TransitionStop>,
    /// The film that was found for it when it was saved.
    #[serde(default, skip_serializing_if = "CachedMatch::is_none")]
    pub found: CachedMatch,
}

/// One of the given forms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DesignEntry {
    /// The file, relative to the document, with `/` between folders; or an
    /// element of a drawing or text, as [`DesignSource`] has it.
    pub path: PathBuf,
    /// What it is called; where it is empty, the file's name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// How the file is read.
    #[serde(default, skip_serializing_if = "is_default")]
    pub import: ImportOptions,
    /// Where it is laid, about its own middle.
    #[serde(default, skip_serializing_if = "is_default")]
    pub placement: Similarity,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl DesignEntry {
    /// A file as it is.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            name: String::new(),
            import: ImportOptions::default(),
            placement: Similarity::default(),
        }
    }

    /// The name that is shown: its own, or else that of its file.
    #[must_use]
    pub fn shown_name(&self) -> String {
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
    /// How the names of documents end, without the dot.
    pub const EXTENSION: &'static str = "morph";

    /// Whether a path is named as a document.
    #[must_use]
    pub fn is_named(path: &Path) -> bool {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(Self::EXTENSION))
    }

    /// Two files with default options. Paths are kept as they are given.
    #[must_use]
    pub fn pair(source: impl Into<PathBuf>, target: impl Into<PathBuf>) -> Self {
        Self::of([source.into(), target.into()])
    }

    /// Files with default options, one after the other, at least two: a pass goes through
    /// all of them and rests at each. Paths are kept as they are given.
    #[must_use]
    pub fn of<P: Into<PathBuf>>(designs: impl IntoIterator<Item = P>) -> Self {
        let designs: Vec<_> = designs.into_iter().map(DesignEntry::new).collect();
        // Of the paths, for nothing is read yet.
        let names: Vec<_> = designs
            .iter()
            .map(|d| DesignSource::of(&d.path).name())
            .collect();
        let mut project = Self::bare(title_of(&names), designs);
        let legs = project.leg_count() as f64;
        project.timing.to = legs;
        project.timing.duration_secs *= legs;
        project.resting_at_designs()
    }

    fn bare(title: String, designs: Vec<DesignEntry>) -> Self {
        Self {
            version: OF_A_PAIR,
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

    /// The oldest version that can say it.
    pub(super) fn needed_version(&self) -> u32 {
        let has_times =
            |stop: &TransitionStop| stop.hold_secs != 0.0 || stop.duration_secs.is_some();
        let has_map = self.map != MapSettings::default();
        if self.is_sequence() || has_map || self.stops.iter().any(has_times) {
            FORMAT_VERSION
        } else {
            OF_A_PAIR
        }
    }
}
