//! A project with changes that were not saved, as it is kept and taken up again.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::app::session::origin::{ProjectOrigin, absolute};
use crate::design::DesignSource;
use crate::io::atomic_file::AtomicFile;
use crate::project::{LoadedProject, Project, ProjectError};

/// A project as it was when it was last changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnsavedProject {
    /// What it is called.
    pub title: String,
    origin: UnsavedOrigin,
    /// The document; its designs are named from the root, or as the gallery names them.
    document: String,
}

/// Where it came from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum UnsavedOrigin {
    Gallery(String),
    File(PathBuf),
    Unsaved,
}

impl UnsavedProject {
    /// A project as it is now.
    ///
    /// # Errors
    /// It cannot be written as a document, which no project does.
    pub fn new(
        title: String,
        origin: &ProjectOrigin,
        loaded: &LoadedProject,
    ) -> Result<Self, ProjectError> {
        let mut project = loaded.project.clone();
        if let Some(folder) = &loaded.folder {
            for entry in &mut project.designs {
                entry.path = absolute(&DesignSource::in_folder(folder, &entry.path).to_path());
            }
        }
        Ok(Self {
            title,
            origin: match origin {
                ProjectOrigin::Gallery(name) => UnsavedOrigin::Gallery(name.clone()),
                ProjectOrigin::File(path) => {
                    UnsavedOrigin::File(std::path::absolute(path).unwrap_or_else(|_| path.clone()))
                }
                ProjectOrigin::Unsaved => UnsavedOrigin::Unsaved,
            },
            document: project.to_toml()?,
        })
    }

    /// Where it came from, and is saved to.
    #[must_use]
    pub fn origin(&self) -> ProjectOrigin {
        match &self.origin {
            UnsavedOrigin::Gallery(name) => ProjectOrigin::Gallery(name.clone()),
            UnsavedOrigin::File(path) => ProjectOrigin::File(path.clone()),
            UnsavedOrigin::Unsaved => ProjectOrigin::Unsaved,
        }
    }

    /// The project with its designs.
    ///
    /// # Errors
    /// A design is no longer there, or is another.
    pub fn load(&self) -> Result<LoadedProject, ProjectError> {
        let folder = match &self.origin {
            UnsavedOrigin::Gallery(_) => None,
            UnsavedOrigin::File(path) => Some(path.parent().unwrap_or(Path::new("")).to_owned()),
            UnsavedOrigin::Unsaved => Some(PathBuf::new()),
        };
        LoadedProject::load(Project::parse(&self.document)?, folder)
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// The disk is full, or the folder is gone.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = AtomicFile::create(path)?;
        file.file_mut().write_all(&serde_json::to_vec(self)?)?;
        file.commit()
    }

    /// Reads it.
    ///
    /// # Errors
    /// It is not there, or none that this program wrote.
    pub fn read(path: &Path) -> io::Result<Self> {
        Ok(serde_json::from_slice(&fs::read(path)?)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::gallery;

    #[test]
    fn what_was_kept_is_there_again() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("kept.json");
        let name = gallery::list()?.remove(0).name;
        let mut loaded = gallery::load(&name)?;
        loaded.project.title = "changed".to_owned();
        let origin = ProjectOrigin::Gallery(name);
        let kept = UnsavedProject::new("changed".to_owned(), &origin, &loaded)?;
        kept.write(&path)?;
        let again = UnsavedProject::read(&path)?;
        assert_eq!((&again, again.origin()), (&kept, origin));
        assert_eq!(again.load()?.project, loaded.project);
        fs::write(&path, "nothing of ours")?;
        assert!(UnsavedProject::read(&path).is_err());
        Ok(())
    }
}
