//! Writing a document.

use super::document::Project;
use super::error::ProjectError;
use crate::atomic_file::AtomicFile;
use std::io::Write;
use std::path::Path;

impl Project {
    /// The document as text.
    ///
    /// # Errors
    /// [`ProjectError::Write`] if a number cannot be written, such as a count
    /// beyond the range of TOML.
    pub fn to_toml(&self) -> Result<String, ProjectError> {
        toml::to_string_pretty(self).map_err(|error| ProjectError::Write(error.to_string()))
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
