//! Where pictures and films go: a folder, and a name that nothing has yet.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use bevy::prelude::Resource;

/// The folder for pictures and films.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct CaptureFolder(pub PathBuf);

impl CaptureFolder {
    /// The folder that was asked for, or `Morphospace` among the user's pictures, or here.
    #[must_use]
    pub fn choose(asked: Option<PathBuf>) -> Self {
        let pictures = || {
            dirs::picture_dir()
                .or_else(dirs::home_dir)
                .unwrap_or_default()
        };
        Self(asked.unwrap_or_else(|| pictures().join("Morphospace")))
    }
}

/// A file (or folder) could not be made.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {source}; choose another folder with --captures")]
pub struct NewFileError {
    path: String,
    source: io::Error,
}

/// Makes a new file `stem.extension`, or `stem-2.extension` and so on where that exists already.
/// Never touches a file that is there, even when two programs do this at once.
///
/// # Errors
/// The folder cannot be made or written to.
pub fn create_new(
    folder: &Path,
    stem: &str,
    extension: &str,
) -> Result<(File, PathBuf), NewFileError> {
    let create = |path: &Path| OpenOptions::new().write(true).create_new(true).open(path);
    first_free(folder, stem, &format!(".{extension}"), create)
}

/// Makes a new folder `stem`, or `stem-2` and so on.
///
/// # Errors
/// The parent cannot be made or written to.
pub fn create_new_folder(folder: &Path, stem: &str) -> Result<PathBuf, NewFileError> {
    first_free(folder, stem, "", |path| std::fs::create_dir(path)).map(|(_, path)| path)
}

fn first_free<T>(
    folder: &Path,
    stem: &str,
    suffix: &str,
    create: impl Fn(&Path) -> io::Result<T>,
) -> Result<(T, PathBuf), NewFileError> {
    let failed = |path: &Path, source| NewFileError {
        path: path.display().to_string(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(|source| failed(folder, source))?;
    let stem = safe(stem);
    // Made at once and not looked for first: two programs that look could both find a name free.
    for number in 1u32.. {
        let name = if number == 1 {
            format!("{stem}{suffix}")
        } else {
            format!("{stem}-{number}{suffix}")
        };
        let path = folder.join(name);
        match create(&path) {
            Ok(made) => return Ok((made, path)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed(&path, error)),
        }
    }
    Err(failed(folder, io::ErrorKind::AlreadyExists.into()))
}

/// The path of what was written. What was only begun is neither picture nor film and is taken away;
/// where even that cannot be done it stays, and the error says what went wrong first.
///
/// # Errors
/// It was not written.
pub fn whole<E>(path: PathBuf, written: Result<(), E>) -> Result<PathBuf, E> {
    if written.is_err() {
        if path.is_dir() {
            std::fs::remove_dir_all(&path).ok();
        } else {
            std::fs::remove_file(&path).ok();
        }
    }
    written.map(|()| path)
}

/// A name that every file system takes: signs that mean something to one of them become `-`.
#[must_use]
pub fn safe(name: &str) -> String {
    let keep = |c: char| {
        if c.is_alphanumeric() || "-_. ".contains(c) {
            c
        } else {
            '-'
        }
    };
    // File systems take names of 255 bytes: 80 signs of three leave room for a number and an
    // ending.
    let kept: String = name.chars().take(80).map(keep).collect();
    // A dot in front hides a file on Unix; dots and blanks at the end are dropped on Windows.
    let trimmed = kept.trim_matches(|c| c == '.' || c == ' ');
    if trimmed.is_empty() {
        "untitled".to_owned()
    } else {
        trimmed.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_overwritten() -> Result<(), Box<dyn std::error::Error>> {
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

    #[test]
    fn names_are_safe() {
        assert_eq!(safe("a/b\\c:d"), "a-b-c-d");
        assert_eq!(safe(".."), "untitled");
        assert_eq!(safe("  Brücke 2 "), "Brücke 2");
    }
}
