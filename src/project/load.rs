//! A document together with the designs it names.

use super::document::{DesignEntry, Project};
use super::error::ProjectError;
use crate::content::ContentKind;
use crate::design::{Design, Source};
use crate::transition::{
    BuildError, Cell, NoSuchCell, Options, TransitionSpec, arranged, arrangement,
};
use crate::warp::WarpKind;
use include_dir::{Dir, File, include_dir};
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
}

impl LoadedProject {
    /// Reads a `.morph` file and its designs.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn open(path: &Path) -> Result<Self, ProjectError> {
        let project = Project::read(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self::load(project, folder)
    }

    /// Reads two designs into a project with default options.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place.
    pub fn open_pair(source: &Path, target: &Path) -> Result<Self, ProjectError> {
        Self::load(Project::pair(source, target), PathBuf::new())
    }

    /// Reads the designs of a document whose paths are relative to `folder`.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place.
    pub fn load(project: Project, folder: PathBuf) -> Result<Self, ProjectError> {
        Self::load_by(project, Some(folder.clone()), |entry| {
            Ok(Source::in_folder(&folder, &entry.path).import(&entry.import)?)
        })
    }

    /// Reads the designs again, after the document has changed what they are
    /// or how they are read.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place.
    pub fn reread(self) -> Result<Self, ProjectError> {
        match self.folder {
            Some(folder) => Self::load(self.project, folder),
            None => Self::load_bundled(self.project),
        }
    }

    /// Reads the bundled designs that a document names.
    pub(super) fn load_bundled(project: Project) -> Result<Self, ProjectError> {
        Self::load_by(project, None, |entry| {
            // A bundled project whose design a user has replaced by a file.
            if entry.path.is_absolute() {
                return Ok(Source::of(&entry.path).import(&entry.import)?);
            }
            let source = Source::parse(&entry.path, |path| bytes(path).is_some());
            let bytes = match source.file() {
                Some(file) => bytes(file).ok_or_else(|| missing(file))?,
                None => &[],
            };
            Ok(source.import_bytes(bytes, &entry.import)?)
        })
    }

    fn load_by(
        project: Project,
        folder: Option<PathBuf>,
        read: impl Fn(&DesignEntry) -> Result<Design, ProjectError>,
    ) -> Result<Self, ProjectError> {
        let designs = project
            .designs
            .iter()
            .map(|entry| {
                let mut design = read(entry)?;
                if !entry.name.is_empty() {
                    design.name.clone_from(&entry.name);
                }
                Ok(Arc::new(design))
            })
            .collect::<Result<Vec<_>, ProjectError>>()?;
        Ok(Self {
            project,
            designs,
            folder,
        })
    }

    /// What the transition is called.
    #[must_use]
    pub fn title(&self) -> String {
        if self.project.title.is_empty() {
            let names: Vec<_> = self.designs.iter().map(|d| d.name.as_str()).collect();
            names.join(" to ")
        } else {
            self.project.title.clone()
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
                let cells = Cell::all().filter(|cell| cell.warp() == warp);
                let suits = |cell: &Cell| (cell.content() == ContentKind::Colours) == photographs;
                let found = cells.clone().find(suits).or_else(|| cells.clone().next());
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
                matching: project.options.matching.placed(&by),
                ..project.options.clone()
            },
        })
    }
}

fn missing(file: &Path) -> ProjectError {
    ProjectError::Io(format!("{} is missing", file.display()))
}
