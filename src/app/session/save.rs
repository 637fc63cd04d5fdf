//! Writing a project so that it can be opened again where it now lies.
//!
//! Paths of designs are relative to the document. A document that moves to another folder names
//! them anew; designs that were bundled with the program are written beside it.

use std::io;
use std::path::{Component, Path, PathBuf};

use crate::app::output_files::{create_new, keep_if_written};
use crate::design::DesignSource;
use crate::project::{LoadedProject, Project, ProjectError, gallery};

/// Why a project was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Nothing is open.
    #[error("There is no project to save.")]
    NothingOpen,
    /// The document could not be written.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// A bundled design could not be written beside it.
    #[error("{file} cannot be written ({error}); save the project in another folder")]
    Design {
        /// The file.
        file: String,
        /// What the system says.
        error: io::Error,
    },
}

/// Writes a project to a path. Where that worked, the loaded project names its designs from
/// there.
///
/// # Errors
/// The document or a bundled design cannot be written; the loaded project is as it was.
pub fn save(loaded: &mut LoadedProject, path: &Path) -> Result<(), SaveError> {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    // A copy, so that a save that fails leaves the open project as it was.
    let project = named_from(loaded.project.clone(), loaded.folder.as_deref(), &folder)?;
    project.save_atomically(&path)?;
    loaded.project = project;
    loaded.folder = Some(folder);
    Ok(())
}

/// The project with its designs named from another folder than the old one, which is none where
/// they are bundled; those are written there.
///
/// # Errors
/// A bundled design cannot be written.
pub fn named_from(
    mut project: Project,
    old: Option<&Path>,
    folder: &Path,
) -> Result<Project, SaveError> {
    for entry in &mut project.designs {
        entry.path = match old {
            Some(old) => DesignSource::in_folder(old, &entry.path)
                .at(|file| relative(folder, file))
                .to_path(),
            // Letters of the bundled font are at home everywhere.
            None if DesignSource::of(&entry.path).file().is_none() => continue,
            // A file that took the place of a bundled design is where it was.
            None if entry.path.is_absolute() => relative(folder, &entry.path),
            None => written_beside(folder, &entry.path)?,
        };
    }
    Ok(project)
}

/// Writes a bundled file into a folder; one that is there with the same content will do.
fn written_beside(folder: &Path, bundled: &Path) -> Result<PathBuf, SaveError> {
    let failed = |error: io::Error| SaveError::Design {
        file: folder.join(bundled).display().to_string(),
        error,
    };
    let bytes = gallery::bytes(bundled).ok_or_else(|| failed(io::ErrorKind::NotFound.into()))?;
    // Else each save of a bundled project would write its designs once more, under new names.
    if std::fs::read(folder.join(bundled)).is_ok_and(|there| there == bytes) {
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

/// The way from a folder to a file, both absolute; the file itself where there is none, as
/// between two drives.
fn relative(folder: &Path, file: &Path) -> PathBuf {
    let (from, to): (Vec<_>, Vec<_>) = (parts(folder), parts(file));
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    // Nothing is shared between two drives, not even the root.
    if shared == 0 || !file.is_absolute() {
        return file.to_owned();
    }
    let up = from[shared..].iter().map(|_| Component::ParentDir);
    up.chain(to[shared..].iter().copied()).collect()
}

fn parts(path: &Path) -> Vec<Component<'_>> {
    path.components()
        .filter(|part| *part != Component::CurDir)
        .collect()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_way_is_relative() {
        let way = |folder, file| relative(Path::new(folder), Path::new(file));
        assert_eq!(way("/a/b", "/a/b/c.svg"), Path::new("c.svg"));
        assert_eq!(way("/a/b", "/a/c.svg"), Path::new("../c.svg"));
        assert_eq!(way("/a/b", "/d/c.svg"), Path::new("../../d/c.svg"));
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
            // To another folder, and onto what is there already.
            let other = folder.path().join(format!("{}.morph", entry.name));
            save(&mut loaded, &other)?;
            save(&mut loaded, &other)?;
            assert_eq!(LoadedProject::open(&other)?.designs, loaded.designs);
        }
        Ok(())
    }
}
