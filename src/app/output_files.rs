//! Output files: the folder for exports, file names that are still free, and the scratch folder for
//! unfinished exports.

use std::ffi::OsStr;
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use bevy::prelude::Resource;

use crate::io::atomic_file::{copy_new, copy_over, place_new};
use crate::io::file_name::safe_file_name;

/// Folder for exported images and films, as the user chose it.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct CaptureFolder {
    /// Folder given on the command line.
    requested: Option<PathBuf>,
    /// Folder that the user chose last for an export.
    last: Option<PathBuf>,
}

impl CaptureFolder {
    /// Folder of the command line, and the one that was chosen last when the program ran before.
    #[must_use]
    pub fn new(requested: Option<PathBuf>, last: Option<PathBuf>) -> Self {
        Self { requested, last }
    }

    /// Folder that the user chose last; `None` before the first export, or if it no longer exists.
    #[must_use]
    pub fn last(&self) -> Option<&Path> {
        self.last.as_deref().filter(|folder| folder.is_dir())
    }

    /// Remembers the folder that the user chose for an export.
    pub fn choose(&mut self, folder: &Path) {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        self.last = Some(folder);
    }

    /// The folder that the user chose last for an export, or else the one given on the command
    /// line, or that of the project, or the folder `Morphospace` in the user's pictures folder,
    /// home folder or current folder, whichever is known first.
    #[must_use]
    pub fn path(&self, of_project: Option<PathBuf>) -> PathBuf {
        let pictures = || {
            let folder = dirs::picture_dir().or_else(dirs::home_dir);
            folder.unwrap_or_default().join("Morphospace")
        };
        let last = self.last().map(Path::to_owned);
        last.or_else(|| self.requested.clone())
            .or(of_project)
            .unwrap_or_else(pictures)
    }
}

/// A file or folder could not be created.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {source}; choose another folder")]
pub struct CreateFileError {
    path: String,
    source: io::Error,
}

/// Creates a new file `stem.extension`, or `stem-2.extension` and so on if that exists. Never
/// touches an existing file, even if two processes do this at once.
///
/// # Errors
/// The folder or the file cannot be created.
pub fn create_new(
    folder: &Path,
    stem: &str,
    extension: &str,
) -> Result<(File, PathBuf), CreateFileError> {
    let create = |path: &Path| OpenOptions::new().write(true).create_new(true).open(path);
    first_free(folder, stem, &format!(".{extension}"), create)
}

/// Calls `create` with the paths `stem`, `stem-2` and so on, each followed by `suffix`, until one
/// is free; returns its result and the path.
fn first_free<T>(
    folder: &Path,
    stem: &str,
    suffix: &str,
    create: impl Fn(&Path) -> io::Result<T>,
) -> Result<(T, PathBuf), CreateFileError> {
    let failed = |path: &Path, source| CreateFileError {
        path: path.display().to_string(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(|source| failed(folder, source))?;
    let stem = safe_file_name(stem);
    // The file is created without a check first: two processes that check could both find the same
    // name free.
    for number in 1u32.. {
        let path = folder.join(numbered_name(&stem, number, suffix));
        match create(&path) {
            Ok(created) => return Ok((created, path)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed(&path, error)),
        }
    }
    Err(failed(folder, io::ErrorKind::AlreadyExists.into()))
}

/// Creates a new folder `stem`, or `stem-2` and so on if that exists.
///
/// # Errors
/// The folder cannot be created.
pub fn create_new_folder(folder: &Path, stem: &str) -> Result<PathBuf, CreateFileError> {
    let create = |path: &Path| std::fs::create_dir(path);
    first_free(folder, stem, "", create).map(|((), path)| path)
}

/// Folder in which exports are prepared before they are moved to their destination. A killed
/// process leaves nothing unfinished among the user's pictures, and the next start cleans up.
/// `None` uses the system's temporary folder.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ScratchFolder(pub Option<PathBuf>);

impl ScratchFolder {
    /// Creates a temporary folder for one export, deleted when dropped.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn create_temp_dir(&self) -> io::Result<tempfile::TempDir> {
        match &self.0 {
            None => tempfile::tempdir(),
            Some(folder) => {
                std::fs::create_dir_all(folder)?;
                tempfile::tempdir_in(folder)
            }
        }
    }
}

/// Checks that a folder can be written to, and creates it if missing. It is called before a long
/// export, which would otherwise fail only at its end.
///
/// # Errors
/// The folder cannot be created or written to.
pub fn check_writable(folder: &Path) -> Result<(), CreateFileError> {
    let attempt = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    attempt.map(drop).map_err(|source| CreateFileError {
        path: folder.display().to_string(),
        source,
    })
}

/// Moves a finished file or folder to `path`, or to a similar path if that is in use; returns the
/// path.
///
/// # Errors
/// The folder cannot be created or written to. In this case nothing is left there.
pub fn move_to_free_path(source_path: &Path, path: &Path) -> Result<PathBuf, CreateFileError> {
    let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new(""));
    if source_path.is_dir() {
        let name = text(path.file_name());
        let (_, path) = first_free(folder, &name, "", |path| move_folder(source_path, path))?;
        return Ok(path);
    }
    let (stem, suffix) = match path.extension() {
        Some(extension) => (path.file_stem(), format!(".{}", text(Some(extension)))),
        None => (path.file_name(), String::new()),
    };
    let place = |path: &Path| place_new(source_path, path);
    let (_, path) = first_free(folder, &text(stem), &suffix, place)?;
    Ok(path)
}

/// Replaces the file `path`, which the user has confirmed, by a finished file.
///
/// # Errors
/// The file cannot be written; it stays as it was.
pub fn replace_file(source_path: &Path, path: &Path) -> Result<(), CreateFileError> {
    copy_over(source_path, path).map_err(|source| CreateFileError {
        path: path.display().to_string(),
        source,
    })
}

/// First of the names `stem`, `stem-2` and so on, each followed by `suffix`, that no file in
/// `folder` has.
#[must_use]
pub fn free_name(folder: &Path, stem: &str, suffix: &str) -> String {
    let stem = safe_file_name(stem);
    let is_free = |name: &String| !folder.join(name).exists();
    let mut names = (1u32..).map(|number| numbered_name(&stem, number, suffix));
    names.find(is_free).unwrap_or(stem)
}

/// The name `stem`, with a number from the second on, followed by `suffix`.
fn numbered_name(stem: &str, number: u32, suffix: &str) -> String {
    match number {
        1 => format!("{stem}{suffix}"),
        _ => format!("{stem}-{number}{suffix}"),
    }
}

/// Moves a folder to a new path; copies its files if it cannot be renamed, as between two disks.
fn move_folder(source_path: &Path, path: &Path) -> io::Result<()> {
    // Created first, because `rename` may overwrite an empty folder.
    std::fs::create_dir(path)?;
    if std::fs::rename(source_path, path).is_ok() {
        return Ok(());
    }
    let copy = || {
        for entry in source_path.read_dir()? {
            let entry = entry?;
            copy_new(&entry.path(), &path.join(entry.file_name()))?;
        }
        Ok(())
    };
    copy().inspect_err(|_| {
        std::fs::remove_dir_all(path).ok();
    })
}

/// Returns the path of a file or folder that was written, or deletes it if writing failed. A failed
/// deletion is ignored in favour of the first error.
///
/// # Errors
/// Writing failed.
pub fn keep_if_written<E>(path: PathBuf, written: Result<(), E>) -> Result<PathBuf, E> {
    if written.is_err() {
        if path.is_dir() {
            std::fs::remove_dir_all(&path).ok();
        } else {
            std::fs::remove_file(&path).ok();
        }
    }
    written.map(|()| path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn existing_files_are_not_overwritten() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let names: Result<Vec<_>, _> = (0..3)
            .map(|_| create_new(folder.path(), "a", "png").map(|(_, path)| path))
            .collect();
        let names: Vec<_> = names?
            .iter()
            .filter_map(|p| p.file_name().map(|n| n.to_owned()))
            .collect();
        assert_eq!(names, ["a.png", "a-2.png", "a-3.png"]);
        Ok(())
    }

    #[test]
    fn finished_exports_take_a_free_name() -> Result<(), Box<dyn std::error::Error>> {
        let (from, to) = (tempfile::tempdir()?, tempfile::tempdir()?);
        let film = from.path().join("film.gif");
        std::fs::write(&film, "frames")?;
        let frames = from.path().join("frames");
        std::fs::create_dir(&frames)?;
        std::fs::write(frames.join("0.png"), "frame")?;
        let folder = to.path().join("films");
        let name = |path: PathBuf| path.file_name().map(|name| name.to_owned());
        assert_eq!(
            name(move_to_free_path(&film, &folder.join("a.gif"))?),
            Some("a.gif".into())
        );
        assert_eq!(
            name(move_to_free_path(&film, &folder.join("a.gif"))?),
            Some("a-2.gif".into())
        );
        assert_eq!(
            name(move_to_free_path(&frames, &folder.join("a"))?),
            Some("a".into())
        );
        assert_eq!(std::fs::read(folder.join("a-2.gif"))?, b"frames");
        assert_eq!(std::fs::read(folder.join("a").join("0.png"))?, b"frame");
        assert_eq!(free_name(&folder, "a", ".gif"), "a-3.gif");
        replace_file(&film, &folder.join("a").join("0.png"))?;
        assert_eq!(std::fs::read(folder.join("a").join("0.png"))?, b"frames");
        // Copying, as is done between two disks.
        copy_new(&film, &folder.join("b.gif"))?;
        assert_eq!(std::fs::read(folder.join("b.gif"))?, b"frames");
        assert!(copy_new(&film, &folder.join("b.gif")).is_err());
        Ok(())
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_an_error_that_names_it()
    -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("file");
        std::fs::write(&file, "")?;
        let error = create_new(&file.join("below"), "a", "png")
            .err()
            .ok_or("no error")?;
        assert!(error.to_string().contains("file"));
        Ok(())
    }
}
