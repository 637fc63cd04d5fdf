//! Where pictures and films go: a folder, and a name that nothing has yet.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use bevy::prelude::Resource;

use crate::io::atomic_file::AtomicFile;
use crate::io::file_name::safe;

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
pub struct CreateFileError {
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
) -> Result<(File, PathBuf), CreateFileError> {
    let create = |path: &Path| OpenOptions::new().write(true).create_new(true).open(path);
    first_free(folder, stem, &format!(".{extension}"), create)
}

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

/// Makes a new folder `stem`, or `stem-2` and so on where something of that name is there.
///
/// # Errors
/// The folder that it is to be in cannot be made or written to.
pub fn create_new_folder(folder: &Path, stem: &str) -> Result<PathBuf, CreateFileError> {
    let create = |path: &Path| std::fs::create_dir(path);
    first_free(folder, stem, "", create).map(|((), path)| path)
}

/// Where films are written before they are moved to their place: a program that is killed leaves
/// nothing half done among the user's pictures, and the next start clears this up. None takes the
/// system's folder for such things.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ScratchFolder(pub Option<PathBuf>);

impl ScratchFolder {
    /// A folder of its own for one piece of work, which goes with it.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn begin(&self) -> io::Result<tempfile::TempDir> {
        match &self.0 {
            None => tempfile::tempdir(),
            Some(folder) => {
                std::fs::create_dir_all(folder)?;
                tempfile::tempdir_in(folder)
            }
        }
    }
}

/// Whether something could be written into a folder, which is made where it is missing: seen before
/// long work and not after it.
///
/// # Errors
/// The folder cannot be made or written to.
pub fn check_writable(folder: &Path) -> Result<(), CreateFileError> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    tried.map(drop).map_err(|source| CreateFileError {
        path: folder.display().to_string(),
        source,
    })
}

/// Moves what was made, a file or a folder, to a name that nothing has yet; returns where it is.
///
/// # Errors
/// The folder cannot be made or written to; nothing is left there then.
pub fn move_to_free_name(
    made: &Path,
    folder: &Path,
    stem: &str,
) -> Result<PathBuf, CreateFileError> {
    if made.is_dir() {
        let (_, path) = first_free(folder, stem, "", |path| move_folder(made, path))?;
        return Ok(path);
    }
    let ending = made.extension().unwrap_or_default().to_string_lossy();
    let (_, path) = first_free(folder, stem, &format!(".{ending}"), |path| {
        // Never over a file that is there, and whole from its first moment on.
        match std::fs::hard_link(made, path) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => copy_new(made, path),
            linked => linked,
        }
    })?;
    Ok(path)
}

/// For other disks, and those that know no links.
fn copy_new(made: &Path, path: &Path) -> io::Result<()> {
    drop(OpenOptions::new().write(true).create_new(true).open(path)?);
    let copy = || {
        let mut file = AtomicFile::create(path)?;
        io::copy(&mut File::open(made)?, file.file_mut())?;
        file.commit()
    };
    copy().inspect_err(|_| {
        std::fs::remove_file(path).ok();
    })
}

fn move_folder(made: &Path, path: &Path) -> io::Result<()> {
    // Taken first, for a folder may be moved over an empty one.
    std::fs::create_dir(path)?;
    if std::fs::rename(made, path).is_ok() {
        return Ok(());
    }
    let copy = || {
        for entry in made.read_dir()? {
            let entry = entry?;
            copy_new(&entry.path(), &path.join(entry.file_name()))?;
        }
        Ok(())
    };
    copy().inspect_err(|_| {
        std::fs::remove_dir_all(path).ok();
    })
}

/// The path of what was written. What was only begun is neither picture nor film and is taken away;
/// where even that cannot be done it stays, and the error says what went wrong first.
///
/// # Errors
/// It was not written.
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
    fn what_is_delivered_takes_a_free_name() -> Result<(), Box<dyn std::error::Error>> {
        let (from, to) = (tempfile::tempdir()?, tempfile::tempdir()?);
        let film = from.path().join("film.gif");
        std::fs::write(&film, "frames")?;
        let frames = from.path().join("frames");
        std::fs::create_dir(&frames)?;
        std::fs::write(frames.join("0.png"), "frame")?;
        let folder = to.path().join("films");
        let name = |path: PathBuf| path.file_name().map(|name| name.to_owned());
        assert_eq!(
            name(move_to_free_name(&film, &folder, "a")?),
            Some("a.gif".into())
        );
        assert_eq!(
            name(move_to_free_name(&film, &folder, "a")?),
            Some("a-2.gif".into())
        );
        assert_eq!(
            name(move_to_free_name(&frames, &folder, "a")?),
            Some("a".into())
        );
        assert_eq!(std::fs::read(folder.join("a-2.gif"))?, b"frames");
        assert_eq!(std::fs::read(folder.join("a").join("0.png"))?, b"frame");
        // As between two disks.
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
