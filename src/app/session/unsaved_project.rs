//! Autosave data: a project with unsaved changes, written as JSON and recovered at the next start.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::app::session::origin::{ProjectOrigin, absolute};
use crate::design::DesignSource;
use crate::io::atomic_file::AtomicFile;
use crate::io::path_text;
use crate::io::read::{self, ReadError};
use crate::project::{LoadedProject, Project, ProjectError};

/// Reason why an autosave was not read.
#[derive(Debug, thiserror::Error)]
pub enum UnsavedReadError {
    /// The file is not regular, or was not written by this program.
    #[error("this is not an autosave")]
    Invalid,
    /// The file cannot be read at the moment.
    #[error(transparent)]
    Unreadable(ReadError),
}

/// A project with unsaved changes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnsavedProject {
    /// Title of the project.
    pub title: String,
    origin: UnsavedOrigin,
    /// Hash of the project file as it was read or last saved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file_hash: Option<u64>,
    /// Text of the project file, with absolute paths to the designs; bundled designs keep their
    /// gallery names.
    document: String,
}

/// Serialised form of [`ProjectOrigin`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum UnsavedOrigin {
    Gallery(String),
    File(#[serde(with = "path_text")] PathBuf),
    Unsaved,
}

impl UnsavedProject {
    /// Stores the current settings of a project as text.
    ///
    /// # Errors
    /// The project cannot be written as text; this does not happen for a valid project.
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
            file_hash: loaded.file_hash,
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

    /// Returns the origin of the project, which stays the same after recovery.
    #[must_use]
    pub fn origin(&self) -> ProjectOrigin {
        match &self.origin {
            UnsavedOrigin::Gallery(name) => ProjectOrigin::Gallery(name.clone()),
            UnsavedOrigin::File(path) => ProjectOrigin::File(path.clone()),
            UnsavedOrigin::Unsaved => ProjectOrigin::Unsaved,
        }
    }

    /// Reads the project and its designs.
    ///
    /// # Errors
    /// A design no longer exists or can no longer be read.
    pub fn load(&self) -> Result<LoadedProject, ProjectError> {
        let folder = match &self.origin {
            UnsavedOrigin::Gallery(_) => None,
            UnsavedOrigin::File(path) => Some(path.parent().unwrap_or(Path::new("")).to_owned()),
            UnsavedOrigin::Unsaved => Some(PathBuf::new()),
        };
        let mut loaded = LoadedProject::load(Project::parse(&self.document)?, folder)?;
        loaded.file_hash = self.file_hash;
        Ok(loaded)
    }

    /// Writes the data to `path` atomically.
    ///
    /// # Errors
    /// The disk is full, or the folder no longer exists.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = AtomicFile::create(path)?;
        file.file_mut().write_all(&serde_json::to_vec(self)?)?;
        file.commit()
    }

    /// Reads the data from `path`; `None` if there is no file.
    ///
    /// # Errors
    /// [`UnsavedReadError`] says whether there is no valid autosave or the file cannot be read.
    pub fn read(path: &Path) -> Result<Option<Self>, UnsavedReadError> {
        match read::read(path) {
            Ok(bytes) => serde_json::from_slice(&bytes)
                .map(Some)
                .map_err(|_| UnsavedReadError::Invalid),
            Err(ReadError::Missing) => Ok(None),
            Err(ReadError::Folder | ReadError::NotRegularFile) => Err(UnsavedReadError::Invalid),
            Err(error) => Err(UnsavedReadError::Unreadable(error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::gallery;
    use std::fs;

    #[test]
    fn written_data_is_read_back() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("unsaved.json");
        let name = gallery::list()?.remove(0).name;
        let mut loaded = gallery::load(&name)?;
        loaded.project.title = "changed".to_owned();
        let origin = ProjectOrigin::Gallery(name);
        let unsaved = UnsavedProject::new("changed".to_owned(), &origin, &loaded)?;
        unsaved.write(&path)?;
        let again = UnsavedProject::read(&path)?.ok_or("no file")?;
        assert_eq!((&again, again.origin()), (&unsaved, origin));
        assert_eq!(again.load()?.project, loaded.project);
        fs::write(&path, "nothing of ours")?;
        assert!(UnsavedProject::read(&path).is_err());
        Ok(())
    }
}
