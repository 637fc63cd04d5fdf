//! Saves a project so that it can be opened again from its new place.
//!
//! Paths of designs are relative to the project file. They are rewritten when the project is saved
//! to another folder; bundled designs are written next to the project file.

use std::io;
use std::path::{Component, Path, PathBuf};

use crate::app::output_files::{create_new, keep_if_written};
use crate::design::DesignSource;
use crate::io::read::{self, ReadError};
use crate::project::{LoadedProject, Project, ProjectError, gallery};

/// Reason why a project was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// No project is open.
    #[error("There is no project to save.")]
    NothingOpen,
    /// The project file could not be written.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// A bundled design could not be written next to the project file.
    #[error("cannot write {file} ({error}); save the project in another folder")]
    Design {
        /// Path of the design file.
        file: String,
        /// Error of the operating system.
        error: io::Error,
    },
}

/// Saves a project to `path`; on success the paths of its designs are relative to the new folder.
///
/// # Errors
/// The project file or a bundled design cannot be written; the loaded project stays as it was.
pub fn save(loaded: &mut LoadedProject, path: &Path) -> Result<(), SaveError> {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    // Works on a copy, so that a failed save leaves the open project unchanged.
    let project = with_relative_paths(loaded.project.clone(), loaded.folder.as_deref(), &folder)?;
    loaded.file_hash = Some(project.save_atomically(&path)?);
    loaded.project = project;
    loaded.folder = Some(folder);
    Ok(())
}

/// Whether the project file `path` differs from the file with this hash. A missing file does not;
/// a file that cannot be read does.
#[must_use]
pub fn is_changed_elsewhere(path: &Path, file_hash: Option<u64>) -> bool {
    match read::read(path) {
        Ok(bytes) => file_hash.is_some_and(|hash| hash != Project::file_hash(&bytes)),
        // Saving reports that these are no files.
        Err(ReadError::Missing | ReadError::Folder | ReadError::NotRegularFile) => false,
        Err(ReadError::TooLarge | ReadError::Io(_)) => true,
    }
}

/// Rewrites the paths of designs from folder `old` to `folder`. If `old` is `None`, the project is
/// bundled, and its designs are written to `folder`.
///
/// # Errors
/// A bundled design cannot be written.
pub fn with_relative_paths(
    mut project: Project,
    old: Option<&Path>,
    folder: &Path,
) -> Result<Project, SaveError> {
    for entry in &mut project.designs {
        entry.path = match old {
            Some(old) => DesignSource::in_folder(old, &entry.path)
                .map_file(|file| relative(folder, file))
                .to_path(),
            // A text in the bundled font has no file.
            None if DesignSource::from_path(&entry.path).file().is_none() => continue,
            // A user's file that replaced a bundled design stays where it is.
            None if entry.path.is_absolute() => relative(folder, &entry.path),
            None => write_bundled_design(folder, &entry.path)?,
        };
    }
    Ok(project)
}

/// Writes a bundled design into a folder and returns the name of its file; an existing file with
/// the same content is reused.
fn write_bundled_design(folder: &Path, bundled: &Path) -> Result<PathBuf, SaveError> {
    let failed = |error: io::Error| SaveError::Design {
        file: folder.join(bundled).display().to_string(),
        error,
    };
    let bytes = gallery::bytes(bundled).ok_or_else(|| failed(io::ErrorKind::NotFound.into()))?;
    // If an equal file were not reused, each save would write the design again under a new name.
    if read::read(&folder.join(bundled)).is_ok_and(|existing| existing == bytes) {
        return Ok(bundled.to_owned());
    }
    let text =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, extension) = (text(bundled.file_stem()), text(bundled.extension()));
    let (_, path) =
        create_new(folder, &stem, &extension).map_err(|error| failed(io::Error::other(error)))?;
    let path = keep_if_written(path.clone(), std::fs::write(&path, bytes)).map_err(failed)?;
    Ok(path.file_name().map(PathBuf::from).unwrap_or(path))
}

/// Relative path from a folder to a file, both absolute; `file` itself if no relative path exists,
/// as between two drives.
fn relative(folder: &Path, file: &Path) -> PathBuf {
    let (from, to): (Vec<_>, Vec<_>) = (parts(folder), parts(file));
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    // Two drives share nothing, not even the root.
    if shared == 0 || !file.is_absolute() {
        return file.to_owned();
    }
    let up = from[shared..].iter().map(|_| Component::ParentDir);
    up.chain(to[shared..].iter().copied()).collect()
}

/// Components of a path; components `.` are left out.
fn parts(path: &Path) -> Vec<Component<'_>> {
    path.components()
        .filter(|part| *part != Component::CurDir)
        .collect()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative() {
        let relative_path = |folder, file| relative(Path::new(folder), Path::new(file));
        assert_eq!(relative_path("/a/b", "/a/b/c.svg"), Path::new("c.svg"));
        assert_eq!(relative_path("/a/b", "/a/c.svg"), Path::new("../c.svg"));
        assert_eq!(
            relative_path("/a/b", "/d/c.svg"),
            Path::new("../../d/c.svg")
        );
    }

    #[test]
    fn a_bundled_project_can_be_saved_and_opened() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        for entry in gallery::list()? {
            let mut loaded = gallery::load(&entry.name)?;
            let path = folder
                .path()
                .join("in")
                .join(format!("{}.morph", entry.name));
            std::fs::create_dir_all(folder.path().join("in"))?;
            save(&mut loaded, &path)?;
            let again = LoadedProject::open(&path)?;
            assert_eq!(again.project, loaded.project);
            assert_eq!(again.designs, loaded.designs);
            // Saving into another folder, and then onto existing files.
            let other = folder.path().join(format!("{}.morph", entry.name));
            save(&mut loaded, &other)?;
            save(&mut loaded, &other)?;
            assert_eq!(LoadedProject::open(&other)?.designs, loaded.designs);
        }
        Ok(())
    }
}
