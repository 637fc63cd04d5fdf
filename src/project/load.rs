//! A document together with the designs it names.

use super::document::{DesignEntry, Project};
use super::error::ProjectError;
use crate::content::ContentKind;
use crate::design::{Design, Source};
use crate::geometry::Similarity;
use crate::one_line::OneLine;
use crate::reading::ReadError;
use crate::transition::{
    BuildError, Cell, NoSuchCell, Options, PartTime, TransitionSpec, arranged, arrangement,
};
use crate::warp::WarpKind;
use include_dir::{Dir, File, include_dir};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files of the gallery, held in the binary.
pub(super) static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// The content of a bundled file, by its path in a bundled document.
#[must_use]
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.get_file(path).map(File::contents)
}

/// A project whose designs have been read.
#[derive(Clone, Debug)]
pub struct LoadedProject {
    /// The document.
    pub project: Project,
    /// The designs as their files give them, in the document's order.
    pub designs: Vec<Arc<Design>>,
    /// What relative paths are relative to; `None` for a bundled project.
    pub folder: Option<PathBuf>,
    /// Whether what takes very long is begun all the same; see
    /// [`crate::budget`].
    pub patient: bool,
}

impl LoadedProject {
    /// Reads a `.morph` file and its designs.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn open(path: &Path) -> Result<Self, ProjectError> {
        let project = Project::read(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self::load(project, Some(folder))
    }

    /// Reads two designs into a project with default options.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place.
    pub fn open_pair(source: &Path, target: &Path) -> Result<Self, ProjectError> {
        Self::load(Project::pair(source, target), Some(PathBuf::new()))
    }

    /// Reads the designs of a document. Its paths are relative to `folder`, or
    /// where there is none to the gallery.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn load(project: Project, folder: Option<PathBuf>) -> Result<Self, ProjectError> {
        let read = |entry: &DesignEntry| {
            let mut design = read(entry, folder.as_deref())?;
            if !entry.name.is_empty() {
                design.name = OneLine(&entry.name).to_string();
            }
            Ok(Arc::new(design))
        };
        // Beside each other: large ones take a second each.
        let designs: Vec<_> = project.designs.par_iter().map(read).collect();
        let designs: Result<_, ProjectError> = designs.into_iter().collect();
        Ok(Self {
            designs: designs?,
            project,
            folder,
            patient: false,
        })
    }

    /// Reads the designs again, after the document has changed what they are
    /// or how they are read.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn reread(self) -> Result<Self, ProjectError> {
        let patient = self.patient;
        let read = Self::load(self.project, self.folder)?;
        Ok(Self { patient, ..read })
    }

    /// What the transition is called, in one line.
    #[must_use]
    pub fn title(&self) -> String {
        if self.project.title.is_empty() {
            let names: Vec<_> = self.designs.iter().map(|d| d.name.as_str()).collect();
            names.join(" to ")
        } else {
            OneLine(&self.project.title).to_string()
        }
    }

    /// The cell that is asked for, or that suits the designs best.
    ///
    /// # Errors
    /// [`NoSuchCell`] if warp and content do not go together.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn cell(&self) -> Result<Cell, NoSuchCell> {
        let default =
            TransitionSpec::new(Arc::clone(&self.designs[0]), Arc::clone(&self.designs[1])).cell;
        match (self.project.warp, self.project.content) {
            (None, None) => Ok(default),
            (Some(warp), Some(content)) => Cell::new(warp, content),
            (Some(warp), None) => {
                let photographs = default.content() == ContentKind::Colours;
                let suits = |cell: &Cell| (cell.content() == ContentKind::Colours) == photographs;
                let cells = Cell::all().filter(|cell| cell.warp() == warp);
                // The first that suits, or the first of all.
                let found = cells.min_by_key(|cell| !suits(cell));
                Ok(found.unwrap_or(default))
            }
            (None, Some(content)) => {
                let mut cells = Cell::all().filter(|cell| cell.content() == content);
                let found = match content {
                    // Without pins the plane stands still.
                    ContentKind::Field | ContentKind::Colours => cells.last(),
                    ContentKind::Solid => cells.next(),
                };
                Ok(found.unwrap_or(default))
            }
        }
    }

    /// Whether these designs can be seen by a cell, without building it.
    ///
    /// # Errors
    /// [`BuildError`] with the reason, for a greyed button.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn available(&self, warp: WarpKind, content: ContentKind) -> Result<(), BuildError> {
        let cell = Cell::new(warp, content)?;
        TransitionSpec::available(cell, &self.designs[0], &self.designs[1])
    }

    /// What the transition is to be built from.
    ///
    /// # Errors
    /// [`ProjectError`] if the cell does not exist or a placement is no
    /// similarity.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn spec(&self) -> Result<TransitionSpec, ProjectError> {
        let project = &self.project;
        let places = [&project.designs[0], &project.designs[1]].map(|entry| entry.placement);
        let designs = [&self.designs[0], &self.designs[1]];
        let by = arrangement(designs, project.fit, places)?;
        let [source, target] = arranged(designs, project.fit, places)?;
        Ok(TransitionSpec {
            source,
            target,
            cell: self.cell().map_err(BuildError::from)?,
            options: Options {
                // Pins are written in the designs' own units, and matched where they are laid.
                matching: project.options.matching.placed(&by),
                parts: placed(&project.options.parts, &by),
                ..project.options.clone()
            },
            patient: self.patient,
            found: project.found.clone(),
        })
    }
}

fn placed(parts: &[PartTime], by: &[Similarity; 2]) -> Vec<PartTime> {
    parts.iter().map(|part| part.placed(by)).collect()
}

/// A design that a document in a folder names, or one of the gallery.
fn read(entry: &DesignEntry, folder: Option<&Path>) -> Result<Design, ProjectError> {
    let source = match folder {
        Some(folder) => Source::in_folder(folder, &entry.path),
        // A bundled project whose design a user has replaced by a file.
        None if entry.path.is_absolute() => Source::of(&entry.path),
        // The binary is its own file system: no path of it is one of the disk's.
        None => {
            let source = Source::parse(&entry.path, |path| bytes(path).is_some());
            let missing = |file: &Path| ProjectError::from(ReadError::Missing).in_file(file);
            let bytes = match source.file() {
                Some(file) => bytes(file).ok_or_else(|| missing(file))?,
                None => &[],
            };
            return Ok(source.import_bytes(bytes, &entry.import)?);
        }
    };
    Ok(source.import(&entry.import)?)
}
