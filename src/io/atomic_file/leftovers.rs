//! Names of temporary files, and removal of those that killed processes left behind.
//!
//! Process 1234 writes `film.gif` as `.film.gif.morphospace-1234-0.part` and keeps that file
//! locked. The system releases the lock when the process ends in any way, so a temporary file that
//! can be locked has no owner and is removed. Process ids could not decide this, because they are
//! reused and differ between machines that share a folder. Without file locks (on Windows, where
//! they would block ffmpeg, and on some network disks) nothing is removed.

use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

#[cfg(unix)]
use crate::io::file_id::FileId;

/// Text in a temporary name between the final name and the process id.
const MARKER: &str = ".morphospace-";

/// Extension of temporary files.
const EXTENSION: &str = ".part";

/// Maximum number of characters of the final name that are used in the temporary name (resource
/// limit: file systems allow names of 255 bytes, and a character takes up to four).
const MAX_NAME_CHARS: usize = 40;

/// Creates and locks a new temporary file in `folder` that is to become `path`. Returns the open
/// file and the path of the temporary file.
pub(super) fn create_temporary(path: &Path, folder: &Path) -> io::Result<(File, PathBuf)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(MAX_NAME_CHARS).collect();
    let owner = std::process::id();
    for number in 0u32.. {
        let temporary = folder.join(format!(".{name}{MARKER}{owner}-{number}{EXTENSION}"));
        match File::create_new(&temporary) {
            Ok(file) if try_lock(&file)? => return Ok((file, temporary)),
            // Before the new file was locked, another process mistook it for the file of a killed
            // process. The next pass of the loop tries a name with the next number.
            Ok(_) => {}
            // The name is used by another thread, or by a process with this id on another machine.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Locks a new file until it is closed. Returns `false` if another process is removing it or has
/// removed it.
#[cfg(unix)]
pub(crate) fn try_lock(file: &File) -> io::Result<bool> {
    use std::fs::TryLockError;
    use std::os::unix::fs::MetadataExt;
    match file.try_lock() {
        Ok(()) => Ok(file.metadata()?.nlink() > 0),
        Err(TryLockError::WouldBlock) => Ok(false),
        // If the file system does not support locks, no process removes the temporary files of
        // others, so the file is safe without a lock.
        Err(TryLockError::Error(_)) => Ok(true),
    }
}

#[cfg(not(unix))]
pub(crate) fn try_lock(_: &File) -> io::Result<bool> {
    Ok(true)
}

/// Removes the temporary files that killed processes left in a folder.
///
/// Errors are ignored: a leftover does no harm.
#[cfg(unix)]
pub(crate) fn remove_leftovers(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        if is_temporary_name(&entry.file_name()) {
            remove_unowned(&entry.path());
        }
    }
}

/// Removes a regular file unless a running process has locked it with [`try_lock`]. Returns whether
/// the file was removed.
#[cfg(unix)]
pub(crate) fn remove_unowned(path: &Path) -> bool {
    // Opening a pipe would block until its other end is opened.
    if std::fs::symlink_metadata(path).is_ok_and(|data| data.is_file())
        && let Ok(file) = open_for_lock(path)
        && file.try_lock().is_ok()
        && is_at(&file, path)
    {
        // The file is removed while it is locked, so that no process can start using it in between.
        return std::fs::remove_file(path).is_ok();
    }
    false
}

/// Removes nothing: without file locks, a running process may use the file.
#[cfg(all(not(unix), feature = "cli"))]
pub(crate) fn remove_unowned(_: &Path) -> bool {
    false
}

/// Opens a file so that it can be locked; network file systems require write access for that.
#[cfg(unix)]
fn open_for_lock(path: &Path) -> io::Result<File> {
    let options = File::options().read(true).write(true).open(path);
    // The temporary file has the permissions of the file it was to replace, which may be read-only.
    options.or_else(|_| File::open(path))
}

/// Returns whether `path` still leads to the open `file`.
///
/// Before the file was locked, its owner may have renamed it, and another file may have taken the
/// path.
#[cfg(unix)]
pub(crate) fn is_at(file: &File, path: &Path) -> bool {
    let locked = file.metadata().ok();
    locked.is_some_and(|locked| FileId::of(path) == Some(FileId::of_metadata(&locked)))
}

/// Returns whether `path` leads to a file: where open files cannot be identified, `file` is assumed
/// to be still there.
#[cfg(all(not(unix), feature = "app"))]
pub(crate) fn is_at(_: &File, path: &Path) -> bool {
    path.is_file()
}

#[cfg(not(unix))]
pub(crate) fn remove_leftovers(_: &Path) {}

/// Returns whether a name has the form that [`create_temporary`] gives.
#[cfg_attr(not(unix), expect(dead_code, reason = "nothing is removed there"))]
fn is_temporary_name(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    let inner = name
        .strip_prefix('.')
        .and_then(|name| name.strip_suffix(EXTENSION));
    let numbers = inner
        .and_then(|inner| inner.rsplit_once(MARKER))
        .and_then(|(_, numbers)| numbers.split_once('-'));
    let is_number = |text: &str| text.parse::<u32>().is_ok();
    numbers.is_some_and(|(owner, number)| is_number(owner) && is_number(number))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn unlocked_leftovers_are_removed_and_everything_else_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let (locked, locked_path) = create_temporary(&at("a.gif"), folder.path()).expect("created");
        let (leftover, leftover_path) =
            create_temporary(&at("b.gif"), folder.path()).expect("created");
        // Releases the lock, as the system does when a process ends.
        drop(leftover);
        for name in [
            "a.gif",
            ".morphospace-x.part",
            ".a.gif.morphospace-12.part",
            ".a.gif.morphospace-12-0.part.txt",
            "a.gif.morphospace-12-0.part",
            ".a.morphospace-one-0.part",
        ] {
            fs::write(at(name), "").expect("written");
        }
        fs::create_dir(at(".d.morphospace-1-0.part")).expect("created");
        remove_leftovers(folder.path());
        assert!(locked_path.exists() && !leftover_path.exists());
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 8);
        drop(locked);
        remove_leftovers(folder.path());
        assert!(!locked_path.exists());
    }

    #[test]
    fn names_of_any_length_work() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["\u{1f980}".repeat(63), "x".repeat(255)] {
            let path = folder.path().join(name);
            let (_, temporary) = create_temporary(&path, folder.path()).expect("created");
            assert!(is_temporary_name(temporary.file_name().expect("a name")));
        }
    }

    #[test]
    fn removing_leftovers_does_not_disturb_concurrent_writers() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x");
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| (0..500).for_each(|_| remove_leftovers(folder.path())));
                scope.spawn(|| {
                    for _ in 0..500 {
                        let (file, temporary) =
                            create_temporary(&path, folder.path()).expect("created");
                        fs::remove_file(temporary).expect("still there");
                        drop(file);
                    }
                });
            }
        });
    }
}
