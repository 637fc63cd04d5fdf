//! What files on their way are called, and how those go that a killed process
//! left behind.
//!
//! `.film.gif.morphospace-1234-0.part` is on its way to `film.gif`, by process
//! 1234. The name is for people; whether the process still runs is told by a
//! lock, which the system frees when it ends, in whatever way: what can be
//! locked is nobody's. Process ids would not do, for they are used again, and
//! say nothing on a folder that machines share. Where there are no such locks
//! (Windows, where they would keep ffmpeg out, and some network disks) nothing
//! is taken away.

use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

const OWNER: &str = ".morphospace-";
const ENDING: &str = ".part";

/// As much of the final name, in characters of up to four bytes: file systems
/// take 255 bytes.
const MOST_OF_NAME: usize = 40;

/// Opens a new file in `folder`, on its way to `path` and locked.
pub(super) fn create_beside(path: &Path, folder: &Path) -> io::Result<(File, PathBuf)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(MOST_OF_NAME).collect();
    let owner = std::process::id();
    for number in 0u32.. {
        let temporary = folder.join(format!(".{name}{OWNER}{owner}-{number}{ENDING}"));
        match File::create_new(&temporary) {
            Ok(file) if is_held(&file)? => return Ok((file, temporary)),
            // Taken by another thread, by a namesake on another machine, or for a
            // leftover in the moment before the lock.
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Locks a new file; `false` where another process is about to take it away, or
/// has.
#[cfg(unix)]
fn is_held(file: &File) -> io::Result<bool> {
    use std::fs::TryLockError;
    use std::os::unix::fs::MetadataExt;
    match file.try_lock() {
        Ok(()) => Ok(file.metadata()?.nlink() > 0),
        Err(TryLockError::WouldBlock) => Ok(false),
        // Without locks nobody takes it away, either.
        Err(TryLockError::Error(_)) => Ok(true),
    }
}

#[cfg(not(unix))]
fn is_held(_: &File) -> io::Result<bool> {
    Ok(true)
}

/// Takes away what killed processes left in a folder. Where that cannot be done
/// it stays: it is in nobody's way.
#[cfg(unix)]
pub(crate) fn remove_leftovers(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten().filter(|e| is_on_its_way(&e.file_name())) {
        let path = entry.path();
        // Opening a pipe would wait for its other end.
        if entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = opened(&path)
            && file.try_lock().is_ok()
            && is_at(&file, &path)
        {
            // Under the lock, so that nobody takes it up meanwhile.
            std::fs::remove_file(path).unwrap_or_default();
        }
    }
}

/// For writing, too: locks on a network want that.
#[cfg(unix)]
fn opened(path: &Path) -> io::Result<File> {
    let options = File::options().read(true).write(true).open(path);
    // It is as open as the file whose place it was to take.
    options.or_else(|_| File::open(path))
}

/// Whether a file is what has that name: it may have been given its own before
/// it was locked, and the name to the next one.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let there = std::fs::metadata(path).map(|there| (there.dev(), there.ino()));
    let locked = file.metadata().map(|locked| (locked.dev(), locked.ino()));
    there.ok().zip(locked.ok()).is_some_and(|(a, b)| a == b)
}

#[cfg(not(unix))]
pub(crate) fn remove_leftovers(_: &Path) {}

/// Whether a name is one that [`create_beside`] gives.
#[cfg_attr(not(unix), expect(dead_code, reason = "nothing is taken away there"))]
fn is_on_its_way(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    let inner = name
        .strip_prefix('.')
        .and_then(|name| name.strip_suffix(ENDING));
    let numbers = inner
        .and_then(|inner| inner.rsplit_once(OWNER))
        .and_then(|(_, numbers)| numbers.split_once('-'));
    let is_number = |text: &str| text.parse::<u32>().is_ok();
    numbers.is_some_and(|(owner, number)| is_number(owner) && is_number(number))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_nobody_holds_goes_and_all_else_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let (held, its_path) = create_beside(&at("a.gif"), folder.path()).expect("created");
        let (left, left_path) = create_beside(&at("b.gif"), folder.path()).expect("created");
        // As the system does when the process ends.
        drop(left);
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
        fs::create_dir(at(".d.morphospace-1-0.part")).expect("made");
        remove_leftovers(folder.path());
        assert!(its_path.exists() && !left_path.exists());
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 8);
        drop(held);
        remove_leftovers(folder.path());
        assert!(!its_path.exists());
    }

    #[test]
    fn a_name_of_any_length_is_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["\u{1f980}".repeat(63), "x".repeat(255)] {
            let path = folder.path().join(name);
            let (_, temporary) = create_beside(&path, folder.path()).expect("created");
            assert!(is_on_its_way(temporary.file_name().expect("a name")));
        }
    }

    #[test]
    fn those_who_take_away_and_those_who_write_do_not_collide() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x");
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| (0..500).for_each(|_| remove_leftovers(folder.path())));
                scope.spawn(|| {
                    for _ in 0..500 {
                        let (file, temporary) =
                            create_beside(&path, folder.path()).expect("created");
                        fs::remove_file(temporary).expect("still there");
                        drop(file);
                    }
                });
            }
        });
    }
}
