//! The document itself, as it stands in the file.

use super::{ProjectError, keys};
use crate::atomic_file::AtomicFile;
use crate::content::ContentKind;
use crate::design::{ImportOptions, Source};
use crate::geometry::Similarity;
use crate::transition::{Fit, Options, Stop, Style, Timing};
use crate::warp::WarpKind;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The version that is written; older ones are read, newer ones refused.
pub const FORMAT_VERSION: u32 = 1;

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
    pub fit: Fit,
    /// The given forms, at least two; the first two are source and target.
    pub designs: Vec<DesignEntry>,
    /// The options of all methods, whose keys stand beside the others in the
    /// file.
    // Reading through `flatten` would lose unknown keys and lines.
    #[serde(flatten, skip_deserializing)]
    pub options: Options,
    /// How it runs over time.
    #[serde(default)]
    pub timing: Timing,
    /// How it is painted.
    #[serde(default)]
    pub style: Style,
    /// Named places on the way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stops: Vec<Stop>,
}

/// One of the given forms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DesignEntry {
    /// The file, relative to the document, with `/` between folders; or an
    /// element of a drawing or text, as [`Source`] has it.
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
}

impl Project {
    /// Two files with default options. Paths are kept as they are given.
    #[must_use]
    pub fn pair(source: impl Into<PathBuf>, target: impl Into<PathBuf>) -> Self {
        let designs = vec![DesignEntry::new(source), DesignEntry::new(target)];
        let names: Vec<_> = designs.iter().map(|d| Source::of(&d.path).name()).collect();
        Self {
            version: FORMAT_VERSION,
            title: names.join(" to "),
            description: String::new(),
            warp: None,
            content: None,
            fit: Fit::default(),
            designs,
            options: Options::default(),
            timing: Timing::default(),
            style: Style::default(),
            stops: Vec::new(),
        }
    }

    /// Reads a document from its text.
    ///
    /// # Errors
    /// [`ProjectError`] names the line of what is wrong.
    pub fn parse(text: &str) -> Result<Self, ProjectError> {
        let project = match keys::read(text) {
            Ok(project) => project,
            // A newer version may well have keys that are unknown here; that
            // it is newer is what its reader needs to hear.
            Err(error) => {
                return Err(match version_of(text) {
                    Some(version) if version > FORMAT_VERSION.into() => {
                        ProjectError::newer(text, version)
                    }
                    _ => error,
                });
            }
        };
        project.check(text)?;
        Ok(project)
    }

    fn check(&self, text: &str) -> Result<(), ProjectError> {
        match self.version {
            0 => return Err(ProjectError::VersionZero),
            v if v > FORMAT_VERSION => return Err(ProjectError::newer(text, v.into())),
            _ => {}
        }
        if self.designs.len() < 2 {
            return Err(ProjectError::TooFewDesigns(self.designs.len()));
        }
        for entry in &self.designs {
            entry.placement.checked()?;
        }
        self.options.field.blend.check()?;
        self.options.colours.check()?;
        self.timing.check(&self.stops)?;
        Ok(())
    }

    /// The document as text.
    ///
    /// # Errors
    /// [`ProjectError::Write`] if a number cannot be written, such as a count
    /// beyond the range of TOML.
    pub fn to_toml(&self) -> Result<String, ProjectError> {
        toml::to_string_pretty(self).map_err(|error| ProjectError::Write(error.to_string()))
    }

    /// Reads a document from a file.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and, where there is one, the line.
    pub fn read(path: &Path) -> Result<Self, ProjectError> {
        let in_file = |error: ProjectError| error.in_file(path);
        let bytes = std::fs::read(path).map_err(|e| in_file(ProjectError::Io(e.to_string())))?;
        let text = String::from_utf8(bytes).map_err(|_| in_file(ProjectError::NotText))?;
        Self::parse(&text).map_err(in_file)
    }

    /// Writes the document beside its final place and moves it there, so that
    /// the old one stays whole until the new one is.
    ///
    /// # Errors
    /// [`ProjectError`] names the file; the old document is untouched.
    pub fn save_atomically(&self, path: &Path) -> Result<(), ProjectError> {
        let text = self.to_toml()?;
        let written = AtomicFile::create(path).and_then(|mut file| {
            file.file_mut().write_all(text.as_bytes())?;
            file.file_mut().sync_all()?;
            file.commit()
        });
        written.map_err(|error| ProjectError::Io(error.to_string()).in_file(path))
    }
}

fn version_of(text: &str) -> Option<u64> {
    let table: toml::Table = text.parse().ok()?;
    u64::try_from(table.get("version")?.as_integer()?).ok()
}
